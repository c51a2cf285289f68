//! Uncertainty of the policy between the demonstrated movements.

use motion::{Demonstrations, LearntPolicy, Trajectory, upper_median};
use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Number of random starts.
const STARTS: usize = 24;
/// Number of states evaluated along each roll-out, and steps between two of them.
const STATES: usize = 8;
const STEPS: usize = 10;
/// A start lies on the line through two demonstrated ones, beyond either by at most this share of their distance.
const BEYOND: f64 = 0.25;
/// The policy is uncertain if its error bars exceed this share of its standard deviation.
const SURE: f64 = 0.5;

/// Share of the states on unconstrained roll-outs from random starts at which the policy's error bars exceed half of its standard
/// deviation; `None` if it has no error bars. `variance`: mean of ‖π̂ − mean‖² over the demonstrations.
pub(crate) fn share_unknown(policy: &dyn LearntPolicy, demonstrations: &Demonstrations, variance: f64) -> Option<f64> {
    let movements = demonstrations.trajectories();
    let mut rng = ChaCha8Rng::seed_from_u64(0);
    let seconds: Vec<f64> = movements.iter().map(Trajectory::duration).collect();
    let usual = upper_median(seconds).expect("there is a demonstration");
    let step = usual / (STATES * STEPS) as f64;
    let mut states: Vec<DVector<f64>> = Vec::with_capacity(STARTS * STATES);
    for _ in 0..STARTS {
        let [from, to] = [0, 1].map(|_| movements[rng.random_range(0..movements.len())].state_in_context(0));
        let mut state = &from + (to - &from) * rng.random_range(-BEYOND..1.0 + BEYOND);
        for _ in 0..STATES {
            states.push(state.clone());
            for _ in 0..STEPS {
                state += policy.action(state.as_view()) * step;
            }
            if state.iter().any(|x| !x.is_finite()) {
                return deviations(policy, &states).map(|_| 1.0);
            }
        }
    }
    let deviations = deviations(policy, &states)?;
    let unknown =
        deviations.column_iter().filter(|deviation| deviation.norm_squared() > SURE * SURE * variance).count();
    Some(unknown as f64 / (STARTS * STATES) as f64)
}

/// Error bars at the states, (n, N); `None` if the policy has none.
fn deviations(policy: &dyn LearntPolicy, states: &[DVector<f64>]) -> Option<DMatrix<f64>> {
    policy.certainty(DMatrix::from_columns(states).as_view()).deviations
}
