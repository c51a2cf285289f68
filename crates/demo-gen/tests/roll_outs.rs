//! Movements under constraints: comparison with an explicit loop, the constraint itself, and the effect of Euler steps
//! on (9).

use constraints::{ConstraintError, LinearConstraint, PfaffianConstraint, Switching, Unconstrained};
use demo_gen::{Parabola, Recording, RollOut, Sinusoidal, demonstrations};
use motion::{NegativeGradient, Policy, Potential};
use nalgebra::{DMatrix, DVector, DVectorView, DVectorViewMut, dvector};
use proptest::collection::vec;
use proptest::prelude::*;

/// One row that turns with time and state, and is sometimes inactive.
#[derive(Debug)]
struct Turning {
    dim: usize,
    rate: f64,
}

impl PfaffianConstraint for Turning {
    fn dim(&self) -> usize {
        self.dim
    }

    fn matrix(&self, state: DVectorView<'_, f64>, time: f64) -> Result<DMatrix<f64>, ConstraintError> {
        let angle = self.rate * time + state.sum();
        let rows = usize::from(angle.sin() > -0.8);
        Ok(DMatrix::from_fn(rows, self.dim, |_, dimension| (angle * (dimension + 1) as f64).cos()))
    }
}

/// π(x) = M x: a policy without a potential, unless M is symmetric.
struct Linear(DMatrix<f64>);

impl Policy for Linear {
    fn dim(&self) -> usize {
        self.0.nrows()
    }

    fn action_into(&self, state: DVectorView<'_, f64>, mut action: DVectorViewMut<'_, f64>) {
        action.gemv(1.0, &self.0, &state, 0.0);
    }
}

/// x ← x + h (I − aᵀa / ‖a‖²) π(x), implemented directly.
fn literal(roll_out: RollOut, policy: &dyn Policy, constraint: &Turning, start: &DVector<f64>) -> Vec<DVector<f64>> {
    let step = roll_out.time_step / roll_out.sub_steps as f64;
    let mut states = vec![start.clone()];
    let mut state = start.clone();
    for count in 0..roll_out.sub_steps * (roll_out.n_samples - 1) {
        let matrix = constraint.matrix(state.as_view(), step * count as f64).expect("it always answers");
        let action = policy.action(state.as_view());
        let mut free = DMatrix::identity(state.len(), state.len());
        if matrix.nrows() == 1 {
            free -= matrix.transpose() * &matrix / matrix.norm_squared();
        }
        state += step * free * action;
        if (count + 1) % roll_out.sub_steps == 0 {
            states.push(state.clone());
        }
    }
    states
}

#[derive(Debug)]
struct Case {
    roll_out: RollOut,
    potential: Parabola,
    constraint: Switching<LinearConstraint>,
    matrices: Vec<DMatrix<f64>>,
    start: DVector<f64>,
}

impl Case {
    /// w δt, below 1.
    fn contraction(&self) -> f64 {
        self.potential.weight * self.roll_out.time_step
    }

    fn record(&self) -> Recording {
        let recording = self.roll_out.record(&self.potential, &self.constraint, self.start.as_view());
        recording.expect("a contraction does not diverge")
    }

    /// The active A at a sample; it changes every three samples.
    fn matrix(&self, sample: usize) -> &DMatrix<f64> {
        &self.matrices[(sample / 3).min(self.matrices.len() - 1)]
    }
}

/// A parabola with any centre, weight and time step with w δt < 1, under constraints with any number of rows.
fn case() -> impl Strategy<Value = Case> {
    let sizes = (1..5usize).prop_flat_map(|n| (Just(n), vec(0..=n + 1, 1..4), 2..12usize));
    sizes.prop_flat_map(|(n, rows, n_samples)| {
        let entries: Vec<_> = rows.iter().map(|k| vec(-1.0..1.0f64, k * n)).collect();
        (0.01..0.95f64, -2.0..1.0f64, entries, vec(-3.0..3.0f64, n), vec(-3.0..3.0f64, n)).prop_map(
            move |(contraction, exponent, entries, centre, start)| {
                let time_step = 10f64.powf(exponent);
                let matrices: Vec<_> =
                    entries.into_iter().zip(&rows).map(|(entries, &k)| DMatrix::from_vec(k, n, entries)).collect();
                let phases = matrices.iter().enumerate().map(|(phase, matrix)| {
                    let constraint = LinearConstraint::new(matrix.clone()).expect("every entry is finite");
                    (time_step * (3 * phase) as f64, constraint)
                });
                Case {
                    roll_out: RollOut { time_step, n_samples, sub_steps: 1 },
                    potential: Parabola { weight: contraction / time_step, centre: DVector::from_vec(centre) },
                    constraint: Switching::new(phases.collect()).expect("the phases follow each other"),
                    matrices,
                    start: DVector::from_vec(start),
                }
            },
        )
    })
}

proptest! {
    #[test]
    fn is_the_literal_loop(
        start in vec(-2.0..2.0f64, 2), rate in -1.0..1.0f64, amplitude in -0.5..0.5f64,
        time_step in 0.05..1.0f64, n_samples in 2..20usize, sub_steps in 1..5usize,
    ) {
        let (roll_out, potential) = (RollOut { time_step, n_samples, sub_steps }, Sinusoidal { amplitude });
        let (constraint, start) = (Turning { dim: 2, rate }, DVector::from_vec(start));
        let recording = roll_out.record(&potential, &constraint, start.as_view()).unwrap();
        let expected = literal(roll_out, &NegativeGradient(&potential), &constraint, &start);
        prop_assert_eq!(recording.observed.n_samples(), n_samples);
        prop_assert_eq!(recording.observed.time_step(), time_step);
        for (sample, state) in expected.iter().enumerate() {
            prop_assert!((recording.observed.state(sample) - state).amax() < 1e-10);
        }
    }

    #[test]
    fn any_policy_follows_the_literal_loop(
        (start, entries) in (1..5usize).prop_flat_map(|n| (vec(-2.0..2.0f64, n), vec(-0.1..0.1f64, n * n))),
        rate in -1.0..1.0f64, time_step in 0.05..1.0f64, n_samples in 2..20usize, sub_steps in 1..5usize,
    ) {
        let (dim, start) = (start.len(), DVector::from_vec(start));
        // The policy contracts towards the centre; otherwise rounding errors would grow until the constraint switches
        // at another sample.
        let policy = Linear(DMatrix::from_vec(dim, dim, entries) - DMatrix::identity(dim, dim) * 0.5);
        let (roll_out, constraint) = (RollOut { time_step, n_samples, sub_steps }, Turning { dim, rate });
        let movement = roll_out.follow(&policy, &constraint, start.as_view()).unwrap();
        prop_assert_eq!((movement.n_samples(), movement.time_step()), (n_samples, time_step));
        for (sample, state) in literal(roll_out, &policy, &constraint, &start).iter().enumerate() {
            prop_assert!((movement.state(sample) - state).amax() < 1e-10);
            let time = time_step * sample as f64;
            let projector = constraint.null_space_projector(movement.state(sample), time).unwrap();
            let velocity = projector.project(policy.action(movement.state(sample)).as_view());
            prop_assert_eq!(movement.velocities().unwrap().column(sample), velocity.column(0));
        }
    }

    /// The movement of a potential and that of its policy are identical to the last bit.
    #[test]
    fn the_policy_of_a_potential_moves_as_the_potential_does(case in case()) {
        let policy = NegativeGradient(&case.potential);
        let movement = case.roll_out.follow(&policy, &case.constraint, case.start.as_view()).unwrap();
        prop_assert_eq!(movement, case.record().observed);
    }

    #[test]
    fn no_velocity_breaks_the_constraint(
        start in vec(-2.0..2.0f64, 4), centre in vec(-2.0..2.0f64, 4), weight in 0.01..0.4f64, rate in -1.0..1.0f64,
        time_step in 0.1..1.0f64, sub_steps in 1..4usize,
    ) {
        let potential = Parabola { weight, centre: DVector::from_vec(centre) };
        let constraint = Turning { dim: 4, rate };
        let roll_out = RollOut { time_step, n_samples: 20, sub_steps };
        let recording = roll_out.record(&potential, &constraint, DVector::from_vec(start).as_view()).unwrap();
        let velocities = recording.observed.velocities().unwrap();
        for sample in 0..20 {
            let matrix = constraint.matrix(recording.observed.state(sample), time_step * sample as f64).unwrap();
            let forbidden = &matrix * velocities.column(sample);
            prop_assert!(forbidden.is_empty() || forbidden.amax() < 1e-13);
            prop_assert_eq!(recording.truth.projectors[sample].rank(), matrix.nrows());
        }
    }

    #[test]
    fn neither_velocities_nor_steps_break_any_number_of_constraints(case in case()) {
        let recording = case.record();
        let velocities = recording.observed.velocities().unwrap();
        for sample in 0..case.roll_out.n_samples {
            let forbidden = case.matrix(sample) * velocities.column(sample);
            prop_assert!(forbidden.is_empty() || forbidden.amax() < 1e-13 * (1.0 + velocities.amax() + recording.truth.actions.amax()));
            if sample + 1 < case.roll_out.n_samples {
                let step = recording.observed.state(sample + 1) - recording.observed.state(sample);
                prop_assert!((step - case.roll_out.time_step * velocities.column(sample)).amax() < 1e-13);
            }
        }
    }

    #[test]
    fn the_displacement_rule_overestimates_by_one_factor(case in case()) {
        let recording = case.record();
        let phi = &recording.truth.potential;
        // States and centre have magnitudes of about 3; this bounds their rounding errors in potentials and squared
        // steps.
        let rounding = 1e-13 * case.potential.weight * 9.0;
        for sample in 1..case.roll_out.n_samples {
            let step = recording.observed.state(sample) - recording.observed.state(sample - 1);
            let by_displacement = -step.norm_squared() / case.roll_out.time_step;
            let change = phi[sample] - phi[sample - 1];
            // by_displacement = change / (1 − w δt), for any projector N.
            prop_assert!((by_displacement * (1.0 - case.contraction()) - change).abs() <= rounding);
            prop_assert!(change <= rounding, "the potential rose");
        }
    }

    #[test]
    fn recorded_truth_matches_potential_and_constraint(case in case()) {
        let recording = case.record();
        let Recording { observed, truth } = &recording;
        prop_assert_eq!(&truth.states, observed.states());
        prop_assert_eq!(observed.state(0).into_owned(), case.start.clone());
        prop_assert_eq!((truth.potential.len(), truth.projectors.len()), (observed.n_samples(), observed.n_samples()));
        for sample in 0..observed.n_samples() {
            let (state, time) = (observed.state(sample), case.roll_out.time_step * sample as f64);
            prop_assert_eq!(truth.potential[sample], case.potential.value(state));
            prop_assert_eq!(truth.actions.column(sample), -case.potential.gradient(state));
            prop_assert_eq!(&truth.projectors[sample], &case.constraint.null_space_projector(state, time).unwrap());
            let seen = observed.velocities().unwrap().column(sample);
            prop_assert_eq!(truth.projectors[sample].project(truth.actions.column(sample)), seen);
        }
    }

    #[test]
    fn sub_steps_approach_the_flow(weight in 0.01..0.3f64, start in vec(-2.0..2.0f64, 3), time_step in 0.1..1.0f64, sub_steps in 1..400usize) {
        let potential = Parabola { weight, centre: DVector::zeros(3) };
        let start = DVector::from_vec(start);
        let roll_out = RollOut { time_step, n_samples: 5, sub_steps };
        let recording = roll_out.record(&potential, &Unconstrained { dim: 3 }, start.as_view()).unwrap();
        // Unconstrained, each sub-step is one multiplication; many of them approximate the exponential.
        let factor = (1.0 - 2.0 * weight * time_step / sub_steps as f64).powf(sub_steps as f64);
        let rate = 2.0 * weight * time_step;
        prop_assert!((factor - (-rate).exp()).abs() <= rate * rate / sub_steps as f64);
        for sample in 0..5 {
            // At most 1600 steps, each rounded to 4e-16.
            prop_assert!((recording.observed.state(sample) - &start * factor.powf(sample as f64)).amax() < 1e-12);
        }
    }
}

#[test]
fn demonstrations_contain_the_observed_movements() {
    let potential = Parabola { weight: 0.1, centre: dvector![0.0, 1.0] };
    let recordings: Vec<_> = [5, 9]
        .map(|n_samples| {
            let roll_out = RollOut { n_samples, ..RollOut::default() };
            roll_out.record(&potential, &Unconstrained { dim: 2 }, dvector![n_samples as f64, 0.0].as_view()).unwrap()
        })
        .into();
    let demonstrations = demonstrations(&recordings).unwrap();
    assert_eq!(demonstrations.n_samples(), 14);
    for (trajectory, recording) in demonstrations.trajectories().iter().zip(&recordings) {
        assert_eq!(trajectory, &recording.observed);
    }
}
