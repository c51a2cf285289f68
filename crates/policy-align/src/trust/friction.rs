//! Movements that are slower than the policy's component along them.

use nalgebra::Vector2;
use prepare::numbers::percent;

use crate::Finding;
use crate::along::{LEAST_T, MotionSample, Regression};

/// Least missing speed, as a share of the root mean square. Its t over movements is 5 and more with friction, below 3.5 with all else. The
/// policy absorbs some of it, so that the share is too low.
const MISSING: f64 = 0.01;

/// A finding if movements that constraints deflect are slower than r = nᵀπ by about the same amount everywhere. `rows`: number of all rows;
/// `movements` holds those that move.
pub(crate) fn friction(movements: &[Vec<MotionSample>], rows: usize) -> Option<Finding> {
    let (missing, t) = missing_speed(movements, rows)?;
    (missing > MISSING && t > LEAST_T).then(|| Finding::doubt(
        format!(
            "movements that constraints turn aside are too slow, by at least {} of the speed: friction, or constraints that give way",
            percent(missing)
        ),
        "reduce friction and hold constraints firmly, or record the velocities that were commanded",
    ))
}

/// Least squares of r − nᵀπ̂ = −f + ε nᵀπ̂ over rows: f relative to the root mean square speed, and its t with movements as the units.
fn missing_speed(movements: &[Vec<MotionSample>], rows: usize) -> Option<(f64, f64)> {
    let missing = Regression::of(movements, |sample| Vector2::new(-1.0, sample.predicted))?;
    let power: f64 = movements.iter().flatten().map(|sample| sample.speed * sample.speed).sum();
    Some((missing.coefficient / (power / rows as f64).sqrt(), missing.t))
}

#[cfg(test)]
mod tests {
    use motion::SampleIndex;
    use nalgebra::{DMatrix, DVector};
    use proptest::prelude::*;

    use super::*;
    use crate::along::{Bowl, along_movements};

    /// Velocities (1 + ε) nᵀπ n in 12 movements, each reduced by `slower`, a function of the sample.
    fn rows(gain: f64, seed: u32, slower: impl Fn(usize) -> f64) -> gp::Rows {
        let angle = |i: usize| f64::from(seed) + 2.4 * i as f64;
        let x = |i: usize| DVector::from_vec(vec![2.0 + angle(i).sin(), (1.7 * angle(i)).cos()]);
        let u = |i: usize| {
            let n = DVector::from_vec(vec![(3.1 * angle(i)).cos(), (3.1 * angle(i)).sin()]);
            let along = -n.dot(&x(i));
            n * along.signum() * (gain * along.abs() - slower(i)).max(0.0)
        };
        let columns = |of: &dyn Fn(usize) -> DVector<f64>| DMatrix::from_columns(&(0..240).map(of).collect::<Vec<_>>());
        let indices = (0..240).map(|i| SampleIndex { trajectory: i / 20, sample: i % 20 });
        gp::Rows::new(columns(&x), columns(&u), indices.collect()).unwrap()
    }

    proptest! {
        /// Friction is found by its size, whatever the error of the policy's size. Noise that slows as often as it accelerates is not
        /// friction.
        #[test]
        fn friction_is_estimated_from_missing_speed(gain in 0.8..1.2f64, friction in 0.05..0.4f64, seed in 0..1000u32) {
            let rows = super::tests::rows(gain, seed, |i| friction * (1.0 + 0.1 * (5.3 * i as f64).sin()));
            let (missing, t) = missing_speed(&along_movements(&Bowl, &rows), rows.len()).unwrap();
            let usual = (rows.velocities().norm_squared() / rows.len() as f64).sqrt();
            prop_assert!((missing * usual / friction - 1.0).abs() < 0.1, "{} {}", missing * usual, friction);
            prop_assert!(t > LEAST_T);
            let found = super::friction(&along_movements(&Bowl, &rows), rows.len()).unwrap();
            prop_assert!(found.what.contains("too slow"));
            let noise = super::tests::rows(gain, seed, |i| 0.05 * (7.7 * i as f64).sin());
            prop_assert!(super::friction(&along_movements(&Bowl, &noise), noise.len()).is_none());
        }
    }
}
