//! Roll-outs of the unconstrained policy.

use motion::{Demonstrations, Policy, Trajectory, upper_median};
use nalgebra::DVector;

/// Largest number of starts.
const STARTS: usize = 20;
/// Duration of each roll-out in median durations of a movement, and its number of steps.
const TIMES: f64 = 5.0;
const STEPS: usize = 200;
/// Share of their extent by which the demonstrated region is larger than the demonstrations.
const BEYOND: f64 = 0.3;

/// Share of the demonstrated starts from which the policy, rolled out without constraints, leaves the demonstrated region.
pub(crate) fn share_leaving(policy: &dyn Policy, demonstrations: &Demonstrations) -> f64 {
    let movements = demonstrations.trajectories();
    let dim = demonstrations.dim();
    let (mut low, mut high) = (DVector::repeat(dim, f64::INFINITY), DVector::repeat(dim, f64::NEG_INFINITY));
    for state in movements.iter().flat_map(|movement| movement.states().column_iter()) {
        let state = state.into_owned();
        low = low.inf(&state);
        high = high.sup(&state);
    }
    let margin = (&high - &low) * BEYOND;
    let (low, high) = (low - &margin, high + margin);
    let seconds: Vec<f64> = movements.iter().map(Trajectory::duration).collect();
    let usual = upper_median(seconds).expect("there is a demonstration");
    let step = TIMES * usual / STEPS as f64;
    let every = movements.len().div_ceil(STARTS);
    let starts: Vec<_> = movements.iter().step_by(every).map(|movement| movement.state_in_context(0)).collect();
    let leaves = |start: &DVector<f64>| {
        let mut state = start.clone();
        (0..STEPS).any(|_| {
            // The midpoint rule: its discretization error does not make a rotation spiral outwards.
            let middle = &state + policy.action(state.as_view()) * (step / 2.0);
            state += policy.action(middle.as_view()) * step;
            let inside = |axis: usize| (low[axis]..=high[axis]).contains(&state[axis]);
            !(0..dim).all(inside)
        })
    };
    starts.iter().filter(|start| leaves(start)).count() as f64 / starts.len() as f64
}
