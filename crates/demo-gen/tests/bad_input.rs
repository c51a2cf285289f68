//! Invalid simulations are refused, with the location of the fault.

use constraints::{ConstraintError, PfaffianConstraint, Unconstrained};
use demo_gen::{DemoGenError, Parabola, Part, Quantity, Redraw, RollOut, ToyPotential, ToySystem};
use motion::{NegativeGradient, Policy, Potential};
use nalgebra::{DMatrix, DVector, DVectorView, DVectorViewMut, dvector};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// A potential with constant value and gradient.
struct Flat {
    value: f64,
    gradient: f64,
}

impl Potential for Flat {
    fn dim(&self) -> usize {
        2
    }

    fn value(&self, _state: DVectorView<'_, f64>) -> f64 {
        self.value
    }

    fn gradient_into(&self, _state: DVectorView<'_, f64>, mut gradient: DVectorViewMut<'_, f64>) {
        gradient.fill(self.gradient);
    }
}

/// One row that changes at a given time.
struct Later {
    time: f64,
    entry: f64,
    columns: usize,
}

impl PfaffianConstraint for Later {
    fn dim(&self) -> usize {
        2
    }

    fn matrix(&self, _state: DVectorView<'_, f64>, time: f64) -> Result<DMatrix<f64>, ConstraintError> {
        Ok(if time >= self.time {
            DMatrix::from_element(1, self.columns, self.entry)
        } else {
            DMatrix::from_element(1, 2, 1.0)
        })
    }
}

fn bowl(weight: f64) -> Parabola {
    Parabola { weight, centre: dvector![0.0, 0.0] }
}

fn refused(
    roll_out: RollOut,
    potential: &dyn Potential,
    constraint: &dyn PfaffianConstraint,
    start: &DVector<f64>,
) -> DemoGenError {
    roll_out.record(potential, constraint, start.as_view()).expect_err("this must be refused")
}

#[test]
fn roll_outs() {
    let (free, start, default) = (Unconstrained { dim: 2 }, dvector![1.0, 0.0], RollOut::default());
    let inf = f64::INFINITY;
    let diverged = |sample, quantity| DemoGenError::Diverged { sample, quantity };
    let dimensions = |part, found| DemoGenError::Dimensions { part, found, expected: 2 };
    let in_constraint = |sample, source| DemoGenError::Constraint { sample, source };
    let not_finite = ConstraintError::NotFinite { row: 0, column: 0, value: inf };
    let long = RollOut { n_samples: 500, ..default };
    let fine = RollOut { sub_steps: 4, time_step: 0.5, ..default };

    let refusals = [
        (
            refused(RollOut { time_step: 0.0, ..default }, &bowl(0.1), &free, &start),
            DemoGenError::TimeStep { time_step: 0.0 },
        ),
        (
            refused(RollOut { time_step: inf, ..default }, &bowl(0.1), &free, &start),
            DemoGenError::TimeStep { time_step: inf },
        ),
        (
            refused(RollOut { n_samples: 1, ..default }, &bowl(0.1), &free, &start),
            DemoGenError::TooFewSamples { n_samples: 1 },
        ),
        (refused(RollOut { sub_steps: 0, ..default }, &bowl(0.1), &free, &start), DemoGenError::NoSubStep),
        (refused(default, &bowl(0.1), &free, &dvector![1.0]), dimensions(Part::Start, 1)),
        (refused(default, &bowl(0.1), &Unconstrained { dim: 3 }, &start), dimensions(Part::Constraint, 3)),
        (refused(default, &bowl(0.1), &free, &dvector![0.0, inf]), diverged(0, Quantity::State)),
        // Each step multiplies the state by −10; 5.5·10^(2·154) is the first potential that exceeds the largest float.
        (refused(long, &bowl(5.5), &free, &start), diverged(154, Quantity::Potential)),
        (refused(default, &Flat { value: 0.0, gradient: inf }, &free, &start), diverged(0, Quantity::Policy)),
        // A step of 1.5e308 is possible only once.
        (refused(default, &Flat { value: 0.0, gradient: 1.5e308 }, &free, &start), diverged(2, Quantity::State)),
        (
            refused(
                default,
                &Flat { value: 0.0, gradient: 1.7e308 },
                &Later { time: 9.0, entry: 1.0, columns: 2 },
                &start,
            ),
            diverged(0, Quantity::Velocity),
        ),
        (
            refused(default, &bowl(0.1), &Later { time: 7.0, entry: inf, columns: 2 }, &start),
            in_constraint(7, not_finite.clone()),
        ),
        // Samples are half a second apart; 7.2 s is on the way from sample 14.
        (
            refused(fine, &bowl(0.1), &Later { time: 7.2, entry: inf, columns: 2 }, &start),
            in_constraint(14, not_finite),
        ),
        (
            refused(default, &bowl(0.1), &Later { time: 3.0, entry: 1.0, columns: 5 }, &start),
            in_constraint(3, ConstraintError::Columns { found: 5, expected: 2 }),
        ),
    ];
    for (found, expected) in refusals {
        assert_eq!(found, expected);
    }
    assert!(matches!(
        refused(RollOut { time_step: f64::NAN, ..default }, &bowl(0.1), &free, &start),
        DemoGenError::TimeStep { .. }
    ));
}

/// A policy with a constant action.
struct Steady {
    action: f64,
}

impl Policy for Steady {
    fn dim(&self) -> usize {
        2
    }

    fn action_into(&self, _state: DVectorView<'_, f64>, mut action: DVectorViewMut<'_, f64>) {
        action.fill(self.action);
    }
}

#[test]
fn roll_outs_of_policies() {
    let (free, start, default) = (Unconstrained { dim: 2 }, dvector![1.0, 0.0], RollOut::default());
    let inf = f64::INFINITY;
    let refused =
        |roll_out: RollOut, policy: &dyn Policy, constraint: &dyn PfaffianConstraint, start: &DVector<f64>| {
            roll_out.follow(policy, constraint, start.as_view()).expect_err("this must be refused")
        };
    let still = Steady { action: 0.0 };
    let diverged = |sample, quantity| DemoGenError::Diverged { sample, quantity };
    let dimensions = |part, found| DemoGenError::Dimensions { part, found, expected: 2 };
    let not_finite = ConstraintError::NotFinite { row: 0, column: 0, value: inf };
    let refusals = [
        (
            refused(RollOut { time_step: -1.0, ..default }, &still, &free, &start),
            DemoGenError::TimeStep { time_step: -1.0 },
        ),
        (
            refused(RollOut { n_samples: 1, ..default }, &still, &free, &start),
            DemoGenError::TooFewSamples { n_samples: 1 },
        ),
        (refused(RollOut { sub_steps: 0, ..default }, &still, &free, &start), DemoGenError::NoSubStep),
        (refused(default, &still, &free, &dvector![1.0]), dimensions(Part::Start, 1)),
        (refused(default, &still, &Unconstrained { dim: 3 }, &start), dimensions(Part::Constraint, 3)),
        (refused(default, &still, &free, &dvector![0.0, inf]), diverged(0, Quantity::State)),
        (refused(default, &Steady { action: inf }, &free, &start), diverged(0, Quantity::Policy)),
        // A step of 1.5e308 is possible only once.
        (refused(default, &Steady { action: 1.5e308 }, &free, &start), diverged(2, Quantity::State)),
        // A policy's potential is not evaluated, so that the state overflows and not its square.
        (
            refused(RollOut { n_samples: 500, ..default }, &NegativeGradient(bowl(5.5)), &free, &start),
            diverged(308, Quantity::Policy),
        ),
        (
            refused(default, &still, &Later { time: 7.0, entry: inf, columns: 2 }, &start),
            DemoGenError::Constraint { sample: 7, source: not_finite },
        ),
    ];
    for (found, expected) in refusals {
        assert_eq!(found, expected);
    }
}

#[test]
fn toy_systems() {
    let good = ToySystem::default;
    let steep = ToyPotential::Parabola(bowl(f64::INFINITY));
    let solid = ToyPotential::Parabola(Parabola { weight: 0.1, centre: dvector![0.0, 0.0, 0.0] });
    let redraw = |redraw| DemoGenError::Redraw { redraw, n_samples: 40 };
    let first = |source| DemoGenError::InTrajectory { trajectory: 0, source: Box::new(source) };
    let cases = [
        (ToySystem { n_trajectories: 0, ..good() }, DemoGenError::NoTrajectory),
        (ToySystem { n_samples: 1, ..good() }, DemoGenError::TooFewSamples { n_samples: 1 }),
        (ToySystem { start_range: -1.0, ..good() }, DemoGenError::StartRange { range: -1.0 }),
        (ToySystem { start_range: f64::INFINITY, ..good() }, DemoGenError::StartRange { range: f64::INFINITY }),
        (ToySystem { redraw: Redraw::Every(0), ..good() }, redraw(Redraw::Every(0))),
        (ToySystem { redraw: Redraw::Segments(0), ..good() }, redraw(Redraw::Segments(0))),
        (ToySystem { redraw: Redraw::Segments(41), ..good() }, redraw(Redraw::Segments(41))),
        (
            ToySystem { potential: steep, ..good() },
            first(DemoGenError::Diverged { sample: 0, quantity: Quantity::Potential }),
        ),
        (
            ToySystem { potential: solid, ..good() },
            first(DemoGenError::Dimensions { part: Part::Start, found: 2, expected: 3 }),
        ),
    ];
    for (system, expected) in cases {
        assert_eq!(system.record(&mut ChaCha8Rng::seed_from_u64(1)).unwrap_err(), expected);
    }
}
