//! Values are stored unchanged, and a policy is the negative gradient of its potential.

use motion::{Demonstrations, NegativeGradient, Policy, Potential, Trajectory};
use nalgebra::{DMatrix, DVector, DVectorView, DVectorViewMut};
use proptest::prelude::*;

/// φ(x) = w‖x − c‖².
struct Bowl {
    weight: f64,
    centre: DVector<f64>,
}

impl Potential for Bowl {
    fn dim(&self) -> usize {
        self.centre.len()
    }

    fn value(&self, state: DVectorView<'_, f64>) -> f64 {
        self.weight * (state - &self.centre).norm_squared()
    }

    fn gradient_into(&self, state: DVectorView<'_, f64>, mut gradient: DVectorViewMut<'_, f64>) {
        gradient.copy_from(&((state - &self.centre) * (2.0 * self.weight)));
    }
}

fn vector(n: usize) -> impl Strategy<Value = DVector<f64>> {
    prop::collection::vec(-3.0..3.0f64, n).prop_map(DVector::from_vec)
}

proptest! {
    #[test]
    fn a_policy_runs_down_its_potential(
        (state, centre) in (1usize..6).prop_flat_map(|n| (vector(n), vector(n))),
        weight in 0.1..2.0f64,
    ) {
        let policy = NegativeGradient(Bowl { weight, centre });
        let action = policy.action(state.as_view());
        prop_assert_eq!(policy.dim(), state.len());
        let step = 1e-6;
        for i in 0..state.len() {
            let mut ahead = state.clone();
            ahead[i] += step;
            let mut behind = state.clone();
            behind[i] -= step;
            let slope = (policy.0.value(ahead.as_view()) - policy.0.value(behind.as_view())) / (2.0 * step);
            prop_assert!((action[i] + slope).abs() < 1e-7 * (1.0 + slope.abs()), "{} and {slope}", action[i]);
        }
    }

    #[test]
    fn demonstrations_keep_what_they_are_given(
        lengths in prop::collection::vec(2usize..6, 1..5),
        dim in 1usize..4,
        time_step in 1e-3..10.0f64,
        scale in -5.0..5.0f64,
    ) {
        let matrix = |(k, &n): (usize, &usize)| DMatrix::from_fn(dim, n, |i, j| scale * (i + 3 * j + 7 * k) as f64);
        let matrices: Vec<_> = lengths.iter().enumerate().map(matrix).collect();
        let demonstrations = Demonstrations::from_states(matrices.clone(), time_step).unwrap();
        prop_assert_eq!(demonstrations.n_trajectories(), lengths.len());
        prop_assert_eq!(demonstrations.dim(), dim);
        prop_assert_eq!(demonstrations.n_samples(), lengths.iter().sum::<usize>());
        for (trajectory, matrix) in demonstrations.trajectories().iter().zip(&matrices) {
            prop_assert_eq!(trajectory.states(), matrix);
            prop_assert_eq!(trajectory.time_step(), time_step);
            prop_assert_eq!(trajectory.velocities(), None);
            let velocities = matrix * 2.0;
            let recorded = trajectory.clone().with_velocities(velocities.clone()).unwrap();
            prop_assert_eq!(recorded.velocities(), Some(&velocities));
            prop_assert_eq!(recorded.states(), matrix);
            for sample in 0..trajectory.n_samples() {
                prop_assert_eq!(trajectory.state(sample), matrix.column(sample));
            }
            let steps = trajectory.step_velocities();
            prop_assert_eq!(steps.shape(), (dim, trajectory.n_samples() - 1));
            for (sample, step) in steps.column_iter().enumerate() {
                prop_assert_eq!(step, (matrix.column(sample + 1) - matrix.column(sample)) / time_step);
            }
        }
        prop_assert_eq!(Demonstrations::new(demonstrations.trajectories().to_vec()), Ok(demonstrations));
    }
}

#[test]
fn references_implement_potential_and_policy() {
    let bowl = Bowl { weight: 0.5, centre: DVector::zeros(2) };
    let state = DVector::from_vec(vec![1.0, -2.0]);
    let potential: &dyn Potential = &bowl;
    assert_eq!((&potential).value(state.as_view()), 2.5);
    assert_eq!(NegativeGradient(potential).action(state.as_view()), -&state);
    let policy: &dyn Policy = &NegativeGradient(&bowl);
    assert_eq!((&policy).action(state.as_view()), -state);
    assert!(Trajectory::new(DMatrix::zeros(2, 2), 1.0).is_ok(), "a movement may rest");
}
