//! Angles: their unit, and jumps by a whole turn.

/// Whether a channel's unit is degrees; `None` if the unit is unknown.
pub fn is_in_degrees(unit: Option<&str>) -> Option<bool> {
    let unit = unit.map(str::to_lowercase).filter(|unit| !unit.is_empty())?;
    Some(matches!(unit.as_str(), "deg" | "degree" | "degrees" | "°"))
}

/// Shares of a jump that velocities contain if they were not computed from the positions, as central differences, or as differences of
/// single steps.
const SHARES: [f64; 3] = [0.0, 0.5, 1.0];

/// Makes one channel of an episode continuous: steps of more than half a turn become short ones, one of exactly half a turn changes its
/// sign. `positions` and `velocities` (empty if none are recorded) are finite, with `dim` numbers a sample; `turn` is a whole turn in
/// the channel's units, and `seconds` are those from the previous sample to a sample. Velocities that jump with the positions, because
/// they are differences of them, are corrected as well.
///
/// # Panics
/// If `dim` is 0, or `channel` is not below it.
pub fn unwrap_angle(
    positions: &mut [f64],
    velocities: &mut [f64],
    (dim, channel): (usize, usize),
    turn: f64,
    seconds: impl Fn(usize) -> f64,
) {
    let mut turns = 0.0;
    let mut before: Option<f64> = None;
    for sample in 0..positions.len() / dim {
        let position = &mut positions[sample * dim + channel];
        let step = before.replace(*position).map_or(0.0, |before| *position - before);
        let whole = (step / turn).round();
        turns -= whole;
        *position += turns * turn;
        if whole == 0.0 || velocities.is_empty() {
            continue;
        }
        let (speed, jump) = ((step - whole * turn) / seconds(sample), whole * turn / seconds(sample));
        for around in [sample - 1, sample] {
            let velocity = &mut velocities[around * dim + channel];
            let without = SHARES.map(|share| *velocity - share * jump);
            let nearest = without.into_iter().min_by(|a, b| (a - speed).abs().total_cmp(&(b - speed).abs()));
            *velocity = nearest.unwrap_or(*velocity);
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;

    proptest! {
        /// An angle that was wrapped becomes continuous again, with the velocities of its steps, whatever its unit; other channels stay.
        #[test]
        fn unwrapping_undoes_wrapping(
            seed in any::<u64>(), dim in 1usize..4, n in 2usize..60, degrees in any::<bool>(), dt in 1e-3..10.0, recorded in 0..3usize
        ) {
            let turn = if degrees { 360.0 } else { std::f64::consts::TAU };
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let channel = rng.random_range(0..dim);
            let mut angle = turn * rng.random_range(-0.5..0.5);
            let mut truth = Vec::new();
            for _ in 0..n {
                truth.extend((0..dim).map(|_| turn * rng.random_range(-2.0..2.0)));
                let last = truth.len() - dim + channel;
                truth[last] = angle;
                angle += turn * if recorded == 0 { rng.random_range(-0.49..0.49) } else { rng.random_range(-0.1..0.1) };
            }
            let mut positions = truth.clone();
            for value in positions.iter_mut().skip(channel).step_by(dim) {
                *value -= turn * (*value / turn).round();
            }
            // No velocities, backward or central differences; those of the wrapped angle jump as well.
            let differences = |of: &[f64]| -> Vec<f64> {
                let before = |k: usize| if k < dim { k } else { k - dim };
                let at = |k: usize| match recorded {
                    1 => (k, before(k)),
                    _ => (if k + dim < of.len() { k + dim } else { k }, before(k)),
                };
                let ratio = |(to, from): (usize, usize)| {
                    if to == from { 0.0 } else { (of[to] - of[from]) / (dt * ((to - from) / dim) as f64) }
                };
                (0..of.len()).map(|k| ratio(at(k))).collect()
            };
            let mut velocities = if recorded > 0 { differences(&positions) } else { Vec::new() };
            unwrap_angle(&mut positions, &mut velocities, (dim, channel), turn, |_| dt);
            let close = |found: &[f64], expected: &[f64], unit: f64| {
                found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-9 * unit)
            };
            prop_assert!(close(&positions, &truth, turn));
            prop_assert!(recorded == 0 || close(&velocities, &differences(&truth), turn / dt));
        }
    }
}
