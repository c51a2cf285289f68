//! The pushes of stretches, compared with the policy.

use nalgebra::DMatrix;

/// A push counts if it differs from the policy's component along it by more than this share of itself.
const DIFFERS: f64 = 0.5;
/// Minimum share of such pushes in the sum of squares of all.
const LEAST: f64 = 0.25;
/// Pushes below this share of the policy's root mean square are too small for components of the policy, and may be noise.
pub(crate) const SMALL: f64 = 0.01;

/// Pushes A⁺b of stretches. If a movement used only some of the directions that its constraint left free, those look like pushes in which
/// its velocity hardly changed.
#[derive(Debug, Clone)]
pub(crate) struct Pushes {
    /// State in the middle of each stretch, with its context, (n + p, S).
    pub(crate) states: DMatrix<f64>,
    /// A⁺b, (n, S), in units of the state per second.
    pub(crate) velocities: DMatrix<f64>,
}

impl Pushes {
    /// Root mean square of the pushes over all stretches; those that the policy's actions at their states, (n, S), explain count as 0, and so
    /// do all if few are left, unless all are small.
    pub(crate) fn root_mean_square(&self, actions: &DMatrix<f64>) -> f64 {
        let (mut all, mut pushing) = (0.0, 0.0);
        for (push, action) in self.velocities.column_iter().zip(actions.column_iter()) {
            let square = push.norm_squared();
            all += square;
            if (push.dot(&action) - square).abs() > DIFFERS * square {
                pushing += square;
            }
        }
        if all < SMALL * SMALL * actions.norm_squared() {
            return (all / actions.ncols() as f64).sqrt();
        }
        if pushing > LEAST * all { (pushing / actions.ncols() as f64).sqrt() } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;

    proptest! {
        /// Components of the policy are no pushes, whatever it does across them. Others count, whatever their number among these.
        #[test]
        fn components_of_the_policy_are_no_pushes(
            dim in 2usize..5,
            components in 1usize..20,
            pushes in 0usize..20,
            size in 0.1..10.0_f64,
            seed in any::<u64>(),
        ) {
            let rng = &mut ChaCha8Rng::seed_from_u64(seed);
            let count = components + pushes;
            let actions = DMatrix::from_fn(dim, count, |_, _| rng.random_range(-1.0..1.0));
            let mut velocities = DMatrix::from_fn(dim, count, |_, _| rng.random_range(-1.0..1.0));
            for (at, (mut velocity, action)) in velocities.column_iter_mut().zip(actions.column_iter()).enumerate() {
                velocity.normalize_mut();
                // A component of the policy, or one that exceeds it.
                velocity *= if at < components { velocity.dot(&action) } else { size + 3.0 * action.norm() };
            }
            let states = DMatrix::zeros(dim, count);
            let exact: f64 = velocities.columns(components, pushes).norm_squared();
            // By chance, all components may be small.
            prop_assume!(velocities.norm() > SMALL * actions.norm());
            let expected = if exact > LEAST * velocities.norm_squared() { (exact / count as f64).sqrt() } else { 0.0 };
            let found = Pushes { states, velocities }.root_mean_square(&actions);
            prop_assert!((found - expected).abs() < 1e-12 * (1.0 + expected), "{found} {expected}");
        }
    }
}
