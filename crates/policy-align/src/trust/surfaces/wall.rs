//! A plane that many movements reach and none crosses: a table, a fence or a joint's stop.

use gp::Rows;
use nalgebra::DVector;
use prepare::Wall;
use prepare::numbers::percent;

use super::{as_recorded, equation, some_of};
use crate::{Finding, Prepared, VelocitySource};

/// Largest dimension n: see [`Wall::of`].
const DIMENSIONS: usize = 8;
/// Largest number of states.
const STATES: usize = 2000;
/// Largest standard deviation of the states on a wall: factors of the noise of positions, as recorded or smoothed, plus a share of the
/// largest distance. Movements that converge to a straight path are less exact.
const NOISE: f64 = 1.3;
const SMOOTHED_NOISE: f64 = 0.6;
const EXACT: f64 = 0.001;
/// Share by which the policy differs from one without constraints; above it, the policy was not misled by the wall.
const DIFFERS: f64 = 0.25;

/// A finding if movements reach a plane that none crosses (S47), and the policy differs little, by `gap`, from one without constraints.
/// An obstacle there may hide where the policy goes.
pub(crate) fn wall(rows: &Rows, prepared: &Prepared, gap: f64) -> Option<Finding> {
    let Prepared { state, noise, .. } = prepared;
    if state.len() < 2 || state.len() > DIMENSIONS || gap >= DIFFERS {
        return None;
    }
    let wall = found(rows, state.len())?;
    let noise =
        noise.positions.as_ref().map_or(0.0, |of| wall.normal.component_mul(&DVector::from_column_slice(of)).norm());
    let times = if matches!(prepared.velocities, VelocitySource::Noisy(_)) { NOISE } else { SMOOTHED_NOISE };
    if wall.thickness > times * noise + EXACT * wall.farthest {
        return None;
    }
    let level = wall.normal.dot(&wall.at);
    let level = if level.abs() < EXACT * wall.farthest { 0.0 } else { level };
    let (normal, length) = as_recorded(&wall.normal, state);
    let plane = equation(&normal, level / length, state);
    Some(Finding::doubt(
        format!("{} of the states lie on the plane {plane}, which no movement crosses", percent(wall.share)),
        "if something stops the hand there, record movements without it: it may hide where the policy goes",
    ))
}

/// The wall among some of the rows, in the learner's units, from their n coordinates of the state without the context.
fn found(rows: &Rows, n: usize) -> Option<Wall> {
    let chosen = some_of(rows.len(), STATES);
    let movement: Vec<usize> = chosen.iter().map(|&row| rows.indices()[row].trajectory).collect();
    Wall::of(&rows.states().rows(0, n).select_columns(&chosen), &movement)
}

#[cfg(test)]
mod tests {
    use motion::SampleIndex;
    use nalgebra::DMatrix;
    use proptest::prelude::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;

    /// Movements of π(x) = −x with noise of positions, and the wall n·x ≤ level, n·x of all starts being less.
    fn movements(normal: &DVector<f64>, level: Option<f64>, noise: f64, rng: &mut ChaCha8Rng) -> Rows {
        let n = normal.len();
        let (mut states, mut velocities, mut indices) = (vec![], vec![], vec![]);
        for trajectory in 0..15 {
            let mut x = DVector::from_fn(n, |_, _| rng.random_range(-2.0..2.0f64));
            if let Some(level) = level {
                x -= normal * (normal.dot(&x) - level).max(0.0) * rng.random_range(1.1..2.0);
            }
            for sample in 0..30 {
                let mut velocity = -&x;
                if level.is_some_and(|level| normal.dot(&x) >= level) {
                    velocity -= normal * normal.dot(&velocity).max(0.0);
                }
                states.push(&x + DVector::from_fn(n, |_, _| noise * rng.random_range(-1.7..1.7)));
                velocities.push(velocity.clone());
                indices.push(SampleIndex { trajectory, sample });
                x += velocity * 0.07;
                if let Some(level) = level {
                    x -= normal * (normal.dot(&x) - level).max(0.0);
                }
            }
        }
        Rows::new(DMatrix::from_columns(&states), DMatrix::from_columns(&velocities), indices).unwrap()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(6))]

        /// A wall across an axis, such as a joint's stop, is found in more dimensions, too.
        #[test]
        fn a_stop_is_found(seed in any::<u64>(), n in 5..9usize, level in -1.0..-0.3f64, noise in 0.0..0.03f64, there in any::<bool>()) {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let axis = rng.random_range(0..n);
            let up = if rng.random() { 1.0 } else { -1.0 };
            let normal = DVector::from_fn(n, |other, _| if other == axis { up } else { 0.0 });
            let found = found(&movements(&normal, there.then_some(level), noise, &mut rng), n);
            prop_assert_eq!(found.is_some(), there);
            prop_assert!(found.is_none_or(|found| found.normal.dot(&normal) > 0.99));
        }

        /// Narrow in one direction, where movements converge fastest, a flat wall is found; a thick one is no wall but a goal.
        #[test]
        fn narrow_walls_are_flat(seed in any::<u64>(), n in 3..9usize, width in 0.13..0.17f64, flat in any::<bool>()) {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let thickness = width * if flat { 0.01 } else { 0.3 };
            let mut uniform = |deviation: f64| 3f64.sqrt() * deviation * rng.random_range(-1.0..1.0);
            let columns: Vec<DVector<f64>> = (0..600).map(|state| {
                let mut x = DVector::from_fn(n, |_, _| uniform(1.0));
                x[1] = uniform(width);
                x[0] = if state % 2 == 0 { uniform(thickness) } else { 2.0 + uniform(1.0) };
                x
            }).collect();
            let movement: Vec<usize> = (0..600).map(|state| state / 30).collect();
            let wall = Wall::of(&DMatrix::from_columns(&columns), &movement);
            prop_assert_eq!(wall.is_some(), flat);
            prop_assert!(wall.is_none_or(|wall| wall.normal[0] < -0.99));
        }

        /// A wall in the way is found, with its normal and place; movements without one have none.
        #[test]
        fn a_wall_is_found(seed in any::<u64>(), n in 2..5usize, level in -1.0..-0.3f64, noise in 0.0..0.03f64, there in any::<bool>()) {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let normal = DVector::from_fn(n, |_, _| rng.random_range(-1.0..1.0f64)).normalize();
            let rows = movements(&normal, there.then_some(level), noise, &mut rng);
            let found = found(&rows, n);
            prop_assert_eq!(found.is_some(), there);
            if let Some(Wall { normal: found, at, share, .. }) = found {
                prop_assert!(found.dot(&normal) > 0.99, "{found} instead of {normal}");
                prop_assert!((found.dot(&at) - level).abs() < 0.05);
                prop_assert!(share > 0.3, "{share}");
            }
        }
    }
}
