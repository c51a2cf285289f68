//! Speeds of the policy that no movement reached.

use motion::Policy;
use nalgebra::DMatrix;
use prepare::numbers::percent;

use crate::Finding;

/// Constraints remove part of the speed, but where they differ between movements, some movement nearly has the policy's speed. Above this
/// factor on the largest recorded speed, the policy is extrapolated.
const TIMES: f64 = 2.0;
/// Share of the policy's mean square that may be extrapolated.
const MOST: f64 = 0.25;

/// Names a policy whose mean square at some states, (n + p, N), is mostly at speeds beyond those `recorded`, (n, M): constraints hold the
/// movements back where the policy is fast. It may be right there, but no movement has tested it.
pub(crate) fn extrapolated(policy: &dyn Policy, states: &DMatrix<f64>, recorded: &DMatrix<f64>) -> Option<Finding> {
    let speeds =
        |velocities: &DMatrix<f64>| -> Vec<f64> { velocities.column_iter().map(|velocity| velocity.norm()).collect() };
    let largest = |speeds: &[f64]| speeds.iter().copied().fold(0.0, f64::max);
    let learnt = speeds(&policy.actions(states.as_view()));
    let recorded = largest(&speeds(recorded));
    let power = |least: f64| learnt.iter().filter(|&&speed| speed > least).map(|speed| speed * speed).sum::<f64>();
    let share = power(TIMES * recorded) / power(0.0);
    (share > MOST).then(|| Finding::doubt(
        format!(
            "where constraints act most, the policy is extrapolated: up to {:.0} times as fast as any movement, {} of its mean square",
            largest(&learnt) / recorded,
            percent(share)
        ),
        "record movements that pass there more freely, or under other constraints",
    ))
}

#[cfg(test)]
mod tests {
    use nalgebra::{DVectorView, DVectorViewMut};
    use proptest::prelude::*;

    use super::*;

    /// π = −x.
    struct Bowl(usize);

    impl Policy for Bowl {
        fn dim(&self) -> usize {
            self.0
        }

        fn action_into(&self, state: DVectorView<'_, f64>, mut action: DVectorViewMut<'_, f64>) {
            action.copy_from(&-state);
        }
    }

    proptest! {
        /// The policy at one state is `far` times as fast as at the others, and the largest recorded speed is `recorded` times theirs.
        #[test]
        fn speeds_beyond_those_recorded_are_found(
            dim in 1usize..8, others in 1usize..60, size in 1e-6f64..1e6, far in 1.0f64..50.0, recorded in 1.0f64..50.0,
        ) {
            let distances = |last: f64| DMatrix::from_fn(dim, others + 1, |k, i| match (k, i) {
                (0, i) if i == others => size * last,
                (0, _) => size,
                _ => 0.0,
            });
            let found = extrapolated(&Bowl(dim), &distances(far), &distances(recorded));
            let share = far * far / (far * far + others as f64);
            prop_assert_eq!(found.is_some(), far > TIMES * recorded && share > MOST);
        }
    }
}
