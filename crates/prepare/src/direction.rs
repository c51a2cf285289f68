use crate::StateChannel;

/// A direction of the state (n) by its channels: "x", "0.7 x − 0.7 y". Small parts are left out, and it has no sign: the
/// first part is positive.
pub fn direction_by_channels(direction: &[f64], state: &[StateChannel]) -> String {
    let largest = direction.iter().fold(0.0_f64, |largest, part| largest.max(part.abs()));
    let parts = direction.iter().zip(state).filter(|(part, _)| **part != 0.0 && part.abs() >= 0.1 * largest);
    let sign = parts.clone().next().map_or(1.0, |(part, _)| part.signum());
    let term = |(at, (part, channel)): (usize, (&f64, &StateChannel))| {
        let (part, name) = (sign * part, &channel.name);
        match (at, part < 0.0) {
            (0, _) if part > 0.99 => name.clone(),
            (0, _) => format!("{part:.1} {name}"),
            (_, true) => format!(" − {:.1} {name}", -part),
            (_, false) => format!(" + {part:.1} {name}"),
        }
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
