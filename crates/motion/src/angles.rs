//! Angles that jump by a whole turn.

/// Makes one channel of an episode continuous: steps of more than half a turn become short ones. `positions` and `velocities`
/// (empty if none are recorded) are `dim` numbers a sample, `turn` is a whole turn in the channel's units, and `seconds` are those
/// from the previous sample to a sample. Velocities that jump with the positions, because they were computed from them, are
/// corrected as well.
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
        for around in [sample - 1, sample] {
            let velocity = &mut velocities[around * dim + channel];
            *velocity -= turn / seconds(sample) * (*velocity * seconds(sample) / turn).round();
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
            seed in any::<u64>(), dim in 1usize..4, n in 2usize..60, degrees in any::<bool>(), dt in 1e-3..10.0, recorded in any::<bool>()
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
                angle += turn * rng.random_range(-0.49..0.49);
            }
            let mut positions = truth.clone();
            for value in positions.iter_mut().skip(channel).step_by(dim) {
                *value -= turn * (*value / turn).round();
            }
            // Backward differences, those of the wrapped angle jump as well.
            let differences = |of: &[f64]| -> Vec<f64> {
                (0..of.len()).map(|k| if k < dim { 0.0 } else { (of[k] - of[k - dim]) / dt }).collect()
            };
            let mut velocities = if recorded { differences(&positions) } else { Vec::new() };
            unwrap_angle(&mut positions, &mut velocities, (dim, channel), turn, |_| dt);
            let close = |found: &[f64], expected: &[f64], unit: f64| {
                found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-9 * unit)
            };
            prop_assert!(close(&positions, &truth, turn));
            prop_assert!(close(&velocities, &differences(&truth), turn / dt));
        }
    }
}
