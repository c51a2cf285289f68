//! Movements towards different goals: the goal is a context, and the learnt policy is valid for new goals.

use crate::drawn;
use crate::drawn::{matrix, rng, vector};
use crate::goals::{Attraction, Goals};
use gp::{AutoFit, AutoGp, Block, FrontEnd, GpError, Hypothesis, Shape, SlopeData, SlopeGp};
use motion::{Demonstrations, LearntPolicy as _, Policy as _, Potential as _, Trajectory};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

fn learner(max_rows: usize) -> AutoGp {
    let slope = SlopeGp { max_rows, hyper_rows: max_rows / 2, ..SlopeGp::default() };
    AutoGp { slope, ..AutoGp::default() }
}

/// Multiplies contexts by their factors.
fn scaled(demonstrations: &Demonstrations, factors: &DVector<f64>) -> Demonstrations {
    let scaled = |of: &Trajectory| of.clone().with_context(of.context().component_mul(factors)).unwrap();
    Demonstrations::new(demonstrations.trajectories().iter().map(scaled).collect()).unwrap()
}

/// The policies learnt from movements, and the factors of their contexts.
fn learnt(demonstrations: &Demonstrations, max_rows: usize) -> (AutoFit, DVector<f64>) {
    let (learner, rng) = (learner(max_rows), &mut rng(1));
    let rows = FrontEnd::Velocities.rows(demonstrations).unwrap();
    let factors = learner.slope.context_factors(&rows, rng).unwrap();
    let rows = FrontEnd::Velocities.rows(&scaled(demonstrations, &factors)).unwrap();
    (learner.fit(&rows, rng).unwrap(), factors)
}

/// nUPE on movements towards new goals.
fn error_at_new_goals(fit: &AutoFit, goals: &Goals, factors: &DVector<f64>, seed: u64) -> f64 {
    let fresh = scaled(&goals.movements(20, 1000 + seed), factors);
    let (mut learnt, mut truth) = (Vec::new(), Vec::new());
    for movement in fresh.trajectories() {
        for sample in (0..movement.n_samples()).step_by(5) {
            let x = movement.state_in_context(sample);
            let action = fit.action(x.rows(0, fit.dim()).into_owned().as_view());
            learnt.push(action.rows(0, goals.dim).into_owned());
            let goal = movement.context().component_div(factors);
            truth.push(goals.policy(&x.rows(0, goals.dim).into_owned(), &goal));
        }
    }
    metrics::nupe(&DMatrix::from_columns(&truth), &DMatrix::from_columns(&learnt)).unwrap()
}

/// The same for policies learnt from states alone.
fn error_without_context(goals: &Goals, demonstrations: &Demonstrations, max_rows: usize, seed: u64) -> f64 {
    let without = |of: &Trajectory| of.clone().with_context(DVector::zeros(0)).unwrap();
    let without = Demonstrations::new(demonstrations.trajectories().iter().map(without).collect()).unwrap();
    let fit = learner(max_rows).fit(&FrontEnd::Velocities.rows(&without).unwrap(), &mut rng(1)).unwrap();
    error_at_new_goals(&fit, goals, &DVector::repeat(goals.dim, 1.0), seed)
}

#[test]
fn new_goals_are_reached_with_their_context_and_not_without() {
    let goals = Goals { dim: 2, attraction: Attraction::Quadratic };
    let demonstrations = goals.movements(20, 1);
    let (fit, factors) = learnt(&demonstrations, 200);
    let error = error_at_new_goals(&fit, &goals, &factors, 1);
    assert!(error < 1e-3, "{error:.1e}");
    assert_eq!(fit.reading(), Hypothesis::Constrained);
    // There are two directions, both observed; the context is not a direction.
    assert_eq!(fit.numbers().least_seen.direction.len(), 2);
    assert!(fit.numbers().seen() && fit.expected_nupe() < 0.01 && fit.warnings().is_empty());
    let without = error_without_context(&goals, &demonstrations, 200, 1);
    assert!(without > 0.1, "{without:.1e}");

    // Far from all demonstrated goals the support of the same state is lower; the trend extrapolates.
    let at = |goal: f64| DVector::from_vec(vec![0.3, 0.4, goal * factors[0], goal * factors[1]]);
    assert!(fit.support(at(0.2).as_view()) > 0.95 && fit.support(at(100.0).as_view()) < fit.support(at(0.2).as_view()));
    let x = at(0.2);
    let mut bars = DVector::repeat(4, f64::NAN);
    assert!(fit.action_sd_into(x.as_view(), bars.as_view_mut()));
    assert!(bars[0] > 0.0 && bars[1] > 0.0 && bars.rows(2, 2).norm() == 0.0);
    assert_eq!(fit.action(x.as_view()).rows(2, 2).norm(), 0.0);

    let text = serde_json::to_string(&fit).unwrap();
    let again: AutoFit = serde_json::from_str(&text).unwrap();
    assert_eq!(again.action(x.as_view()), fit.action(x.as_view()));
    assert_eq!(again.direct().action(x.as_view()), fit.direct().action(x.as_view()));
    assert_eq!(again.support(x.as_view()), fit.support(x.as_view()));
}

/// Five seeds in two and three dimensions with twenty and forty goals.
#[test]
#[ignore = "forty fits: minutes"]
fn new_goals_are_reached() {
    for (dim, attraction, count, most) in [
        (2, Attraction::Quadratic, 20, 1e-3),
        (2, Attraction::Well, 20, 0.05),
        (2, Attraction::Well, 40, 0.01),
        (3, Attraction::Quadratic, 20, 2e-3),
        (3, Attraction::Quadratic, 40, 1e-3),
        (3, Attraction::Well, 40, 0.05),
    ] {
        for seed in 1..=5 {
            let goals = Goals { dim, attraction };
            let demonstrations = goals.movements(count, seed);
            let (fit, factors) = learnt(&demonstrations, 400);
            let error = error_at_new_goals(&fit, &goals, &factors, seed);
            let without = error_without_context(&goals, &demonstrations, 400, seed);
            let (expected, r2) = (fit.expected_nupe(), fit.slope().report().r_squared);
            eprintln!(
                "{dim}-D {attraction:?}, {count} goals: {error:.1e}, expected {expected:.1e}, without context {without:.2}, 1 − R² {:.1e}",
                1.0 - r2
            );
            assert!(error < most && without > 0.1 && expected > error / 10.0);
        }
    }
}

#[test]
fn contexts_are_checked() {
    let rows = || drawn::rows(2, (4, 5), |x| -x, &mut rng(3));
    let refused = |context: &DMatrix<f64>| rows().with_context(context).unwrap_err();
    assert!(matches!(refused(&DMatrix::zeros(1, 19)), GpError::Lengths { found: 19, expected: 20, .. }));
    let mut context = DMatrix::zeros(2, 20);
    context[(1, 7)] = f64::NAN;
    assert!(matches!(refused(&context), GpError::Value { what: "context", row: 7, .. }));
    context[(1, 7)] = 1e200;
    assert!(matches!(refused(&context), GpError::Overflow { .. }));
    assert_eq!(rows().with_context(&DMatrix::zeros(0, 20)).unwrap(), rows());
    let with = rows().with_context(&DMatrix::repeat(3, 20, 0.5)).unwrap();
    assert_eq!((with.dim(), with.context_dim(), with.states().nrows(), with.velocities().nrows()), (2, 3, 5, 2));
}

fn any_block() -> impl Strategy<Value = Block> {
    let shapes = prop_oneof![Just(Shape::SquaredExponential), Just(Shape::Matern52), Just(Shape::Matern32)];
    prop_oneof![
        Just(Block::Linear),
        Just(Block::Quadratic),
        Just(Block::Skew),
        (shapes, 0.3..3.0).prop_map(|(shape, scale)| Block::Potential(shape, scale)),
        (0.3..3.0).prop_map(Block::DivergenceFree),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    /// A context is a part of the state without directions; rotation depends on it only through a distance.
    #[test]
    fn a_context_is_state_that_does_not_move(
        block in any_block(),
        (dim, context) in (1_usize..4, 0_usize..3),
        seed in any::<u64>(),
    ) {
        let rng = &mut rng(seed);
        let (z, z2) = (vector(dim + context, rng), vector(dim + context, rng));
        let (n, n2) = (vector(dim, rng).normalize(), vector(dim, rng).normalize());
        let padded = |n: &DVector<f64>| n.clone().resize_vertically(dim + context, 0.0);
        let found = block.slope_slope(z.as_view(), n.as_view(), z2.as_view(), n2.as_view());
        let x = |z: &DVector<f64>| z.rows(0, dim).into_owned();
        let expected = match block {
            Block::Skew => Block::Skew.slope_slope(x(&z).as_view(), n.as_view(), x(&z2).as_view(), n2.as_view()),
            Block::DivergenceFree(scale) => {
                // The same length, in units of fewer dimensions.
                let own = scale * ((dim + context) as f64 / dim as f64).sqrt();
                let of_state = Block::DivergenceFree(own);
                let apart = (&z - &z2).rows(dim, context).norm_squared();
                let squared = 2.0 * (dim + context) as f64 * scale * scale;
                (-0.5 * apart / squared).exp()
                    * of_state.slope_slope(x(&z).as_view(), n.as_view(), x(&z2).as_view(), n2.as_view())
            }
            _ => block.slope_slope(z.as_view(), padded(&n).as_view(), z2.as_view(), padded(&n2).as_view()),
        };
        prop_assert!((found - expected).abs() <= 1e-10 * (1.0 + expected.abs()), "{found} {expected}");
        let policy = block.policy_slope(z.as_view(), z2.as_view(), n2.as_view());
        prop_assert!((policy.dot(&n) - found).abs() <= 1e-10 * (1.0 + found.abs()));
    }

    /// The fast evaluation equals (S7), and the negative gradient of the potential in every context.
    #[test]
    fn policies_in_context_are_sums_over_rows(
        blocks in prop::collection::vec(any_block(), 1..4),
        (dim, context) in (1_usize..4, 0_usize..3),
        seed in any::<u64>(),
    ) {
        let rng = &mut rng(seed);
        let rows = drawn::rows(dim, (6, 4), drawn::descent, rng).with_context(&matrix(context, 24, rng)).unwrap();
        let theta: Vec<f64> = (0..=blocks.len()).map(|k| -0.5 - 0.3 * k as f64).collect();
        let data = SlopeData::new(&rows, vec![1.0; 24]).unwrap();
        let (model, _) = data.condition(&blocks, &theta, 1.0).unwrap();
        let (mean, spread) = data.scaling();
        let scale = |x: &DVector<f64>| (x - DVector::from_column_slice(mean)) / spread;
        let state = vector(dim + context, rng);
        let z = scale(&state);
        let mut expected = DVector::zeros(dim);
        for (row, weight) in model.weights().iter().enumerate() {
            let (z2, n2) = (scale(&rows.states().column(row).into_owned()), rows.velocities().column(row).normalize());
            for (block, theta) in blocks.iter().zip(&theta) {
                expected += block.policy_slope(z.as_view(), z2.as_view(), n2.as_view()) * (theta.exp() * weight * data.unit());
            }
        }
        let action = model.policy().action(state.as_view());
        prop_assert!((action.rows(0, dim) - &expected).amax() <= 1e-9 * (1.0 + expected.amax()));
        prop_assert_eq!(action.rows(dim, context).norm(), 0.0);
        if let Some(potential) = model.potential() {
            let gradient = potential.gradient(state.as_view());
            for axis in 0..dim {
                let at = |by: f64| { let mut x = state.clone(); x[axis] += by; potential.value(x.as_view()) };
                let slope = (at(1e-5) - at(-1e-5)) / 2e-5;
                prop_assert!((slope - gradient[axis]).abs() <= 1e-4 * (1.0 + slope.abs()), "{slope} {}", gradient[axis]);
            }
        }
        // Error bars: two forms of the prior agree, and the posterior never exceeds it.
        let (posterior, prior) = (model.covariance(state.as_view()), model.prior_covariance(state.as_view()));
        prop_assert_eq!(posterior.shape(), (dim, dim));
        prop_assert!((0..dim).all(|k| posterior[(k, k)] <= prior[(k, k)] * (1.0 + 1e-9)));
    }
}
