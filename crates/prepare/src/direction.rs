use crate::StateChannel;

/// A direction of the state (n) in terms of its channels: "x", "0.7 x − 0.7 y". Small components are omitted. The
/// direction has no sign: its first component is positive.
pub fn direction_by_channels(direction: &[f64], state: &[StateChannel]) -> String {
    let names: Vec<&str> = state.iter().map(|channel| channel.name.as_str()).collect();
    let largest = direction.iter().fold(0.0_f64, |largest, part| largest.max(part.abs()));
    let first = direction.iter().find(|part| **part != 0.0 && part.abs() >= 0.1 * largest);
    let sign = first.map_or(1.0, |part| part.signum());
    let direction: Vec<f64> = direction.iter().map(|part| sign * part).collect();
    sum_of_parts(&direction, &names, 1)
}

/// A direction as a sum of named components with `decimals` decimals; components that round to 0 relative to the largest
/// are omitted.
pub fn sum_of_parts(direction: &[f64], names: &[&str], decimals: u8) -> String {
    let largest = direction.iter().fold(0.0_f64, |largest, part| largest.max(part.abs()));
    let least = 0.1_f64.powi(i32::from(decimals));
    let decimals = usize::from(decimals);
    let parts = direction.iter().zip(names).filter(|(part, _)| **part != 0.0 && part.abs() >= least * largest);
    let term = |(at, (&part, name)): (usize, (&f64, &&str))| match (at, part < 0.0) {
        (0, false) if part > 1.0 - 0.1 * least => (*name).to_owned(),
        (0, false) => format!("{part:.decimals$} {name}"),
        (0, true) => format!("−{:.decimals$} {name}", -part),
        (_, true) => format!(" − {:.decimals$} {name}", -part),
        (_, false) => format!(" + {part:.decimals$} {name}"),
    };
    parts.enumerate().map(term).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_name_the_channels_that_matter() {
        let channel = |name: &str| StateChannel {
            name: name.to_owned(),
            unit: None,
            scale: 1.0,
            low: 0.0,
            high: 1.0,
            median: 0.5,
        };
        let state = ["x", "y", "z"].map(channel);
        assert_eq!(direction_by_channels(&[-0.999, 0.008, 0.0], &state), "x");
        assert_eq!(direction_by_channels(&[0.6, 0.0, -0.8], &state), "0.6 x − 0.8 z");
        assert_eq!(direction_by_channels(&[-0.6, 0.52, -0.61], &state), "0.6 x − 0.5 y + 0.6 z");
        assert_eq!(direction_by_channels(&[0.0; 3], &state), "");
    }
}
