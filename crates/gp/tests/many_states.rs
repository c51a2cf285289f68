//! Predictions equal the sums that define them, with the same bits one by one, at many states and on any number of threads.

use crate::drawn::{descent, matrix, rng, rows, vector};
use gp::{
    Block, CurlTest, DirectBlock, DirectFit, DirectFormula, DirectGp, Fall, Family, Rows, SlopeFit, SlopeFormula,
    SlopeGp, Term,
};
use motion::{LearntPolicy, Policy as _, Potential as _};
use nalgebra::{DMatrix, DVector, DVectorView};
use proptest::prelude::*;

fn families() -> impl Strategy<Value = Family> {
    prop_oneof![Just(Family::Smooth), Just(Family::Medium), Just(Family::Rough)]
}

/// Rows with a context of given dimension, constant along each trajectory, of a policy that may rotate.
fn in_context((dim, rotates): (usize, bool), context: usize, (trajectories, per): (usize, usize), seed: u64) -> Rows {
    let rng = &mut rng(seed);
    let turned = |x: &DVector<f64>| DVector::from_fn(dim, |k, _| [-x[1], x[0]].get(k).copied().unwrap_or(0.0));
    let policy = |x: &DVector<f64>| if rotates { turned(x) * 3.0 } else { descent(x) };
    let rows = rows(dim, (trajectories, per), policy, rng);
    let contexts = matrix(context, trajectories, rng);
    let of_rows = DMatrix::from_fn(context, rows.len(), |k, row| contexts[(k, row / per)]);
    if context == 0 { rows } else { rows.with_context(&of_rows).unwrap() }
}

fn fits(rows: &Rows, family: Family, rotates: bool) -> (SlopeFit, DirectFit) {
    let curl_test = if rotates { CurlTest::Fit } else { CurlTest::AssumePotential };
    let slope = SlopeGp { families: vec![family], hyper_rows: 40, curl_test, ..SlopeGp::default() };
    let direct = DirectGp { families: vec![family], hyper_rows: 40, ..DirectGp::default() };
    (slope.fit(rows, &mut rng(1)).unwrap(), direct.fit(rows, &mut rng(1)).unwrap())
}

/// The scale of a length in `dim` dimensions.
fn scale(term: &Term, dim: usize) -> f64 {
    term.length / (2.0 * dim as f64).sqrt()
}

/// Σ α (g n − h β a) over rows and terms, Σ α g β, and the sums of their magnitudes.
fn literal_slope(formula: &SlopeFormula<'_>, z: DVectorView<'_, f64>) -> (DVector<f64>, f64, f64) {
    let n = formula.directions.nrows();
    let (mut action, mut potential, mut magnitude) = (DVector::zeros(n), 0.0, 0.0);
    for term in &formula.terms {
        let scale = scale(term, z.len());
        let block = match term.fall {
            Fall::Shape(shape) => Block::Potential(shape, scale),
            Fall::DivergenceFree => Block::DivergenceFree(scale),
        };
        for (state, direction) in formula.scaled.z.column_iter().zip(formula.directions.column_iter()) {
            let part = block.policy_slope(z, state, direction) * term.amplitude;
            magnitude += part.norm();
            action += part;
            potential -= term.amplitude * block.potential_slope(z, state, direction).unwrap_or(0.0);
        }
    }
    (action, potential, magnitude)
}

/// Σ k(z, z') A, and the sum of the magnitudes.
fn literal_direct(formula: &DirectFormula<'_>, z: DVectorView<'_, f64>) -> (DVector<f64>, f64) {
    let (mut action, mut magnitude) = (DVector::zeros(formula.weights.nrows()), 0.0);
    let [constant, linear, quadratic] = formula.trend;
    for (state, weights) in formula.scaled.z.column_iter().zip(formula.weights.column_iter()) {
        let product = z.dot(&state);
        let of_term = |term: &Term| {
            let Fall::Shape(shape) = term.fall else { panic!("{term:?}") };
            term.amplitude * DirectBlock::Shape(shape, scale(term, z.len())).covariance(z, state)
        };
        let trend = constant + linear * product + quadratic * product * product;
        let covariance = trend + formula.terms.iter().map(of_term).sum::<f64>();
        magnitude += covariance.abs() * weights.norm();
        action += weights * covariance;
    }
    (action, magnitude)
}

/// Outputs at each state separately.
fn one_by_one(policy: &dyn LearntPolicy, states: &DMatrix<f64>) -> (DMatrix<f64>, DMatrix<f64>, Vec<f64>) {
    let (mut actions, mut deviations) = (states.clone(), states.clone());
    for ((state, action), mut deviation) in
        states.column_iter().zip(actions.column_iter_mut()).zip(deviations.column_iter_mut())
    {
        policy.action_into(state, action);
        let mut place = DVector::zeros(state.len());
        assert!(policy.action_sd_into(state, place.as_view_mut()));
        deviation.copy_from(&place);
    }
    (actions, deviations, states.column_iter().map(|state| policy.support(state)).collect())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Includes more dimensions than fit on the stack.
    #[test]
    fn predictions_are_sums_over_rows(
        (family, rotates) in (families(), any::<bool>()), dim in prop_oneof![2_usize..6, Just(35)],
        context in 0_usize..3, (trajectories, per) in (4_usize..7, 10_usize..16), seed in any::<u64>(),
    ) {
        let rows = in_context((dim, rotates), context, (trajectories, per), seed);
        let (slope, direct) = fits(&rows, family, rotates);
        let (of_slope, of_direct) = (slope.formula(), direct.formula());
        for _ in 0..5 {
            let x = vector(dim + context, &mut rng(seed ^ 1));
            let scaled = of_slope.scaled;
            let z = DVector::from_fn(x.len(), |k, _| (x[k] - scaled.mean[k]) / scaled.spread);
            let (action, potential, magnitude) = literal_slope(&of_slope, z.as_view());
            let trend = &of_slope.constant + &of_slope.matrix * &z;
            let expected = (action + trend.rows(0, dim)) * scaled.speed;
            let tolerance = 1e-13 * scaled.speed * (magnitude + trend.norm());
            let found = slope.action(x.as_view());
            prop_assert!((found.rows(0, dim) - &expected).norm() <= tolerance, "{found} {expected}");
            prop_assert!(found.iter().skip(dim).all(|along| *along == 0.0));
            if let Some(phi) = slope.potential() {
                let sum = potential + z.dot(&(&of_slope.constant + &of_slope.matrix * &z * 0.5));
                let expected = -scaled.speed * scaled.spread * sum;
                let tolerance = tolerance * scaled.spread * (1.0 + z.norm()) * 10.0;
                prop_assert!((phi.value(x.as_view()) - expected).abs() <= tolerance);
            }

            let scaled = of_direct.scaled;
            let z = DVector::from_fn(x.len(), |k, _| (x[k] - scaled.mean[k]) / scaled.spread);
            let (expected, magnitude) = literal_direct(&of_direct, z.as_view());
            let off = (direct.action(x.as_view()).rows(0, dim) - expected * scaled.speed).norm();
            prop_assert!(off <= 1e-13 * scaled.speed * magnitude, "{off}");
        }
    }

    /// A few states, and more than one thread gets.
    #[test]
    fn batch_predictions_equal_single_ones(
        (family, rotates) in (families(), any::<bool>()), dim in 2_usize..5, context in 0_usize..3, count in 1_usize..150,
        threads in 1_usize..4, seed in any::<u64>(),
    ) {
        let (slope, direct) = fits(&in_context((dim, rotates), context, (5, 9), seed), family, rotates);
        let states = matrix(dim + context, count, &mut rng(seed ^ 2)) * 1.5;
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        for policy in [&slope as &dyn LearntPolicy, &direct] {
            let (actions, deviations, support) = one_by_one(policy, &states);
            let (together, certainty) = pool.install(|| (policy.actions(states.as_view()), policy.certainty(states.as_view())));
            prop_assert_eq!(together, actions);
            for least in [0.0, 0.1, 0.5, 0.9, 0.999] {
                let supported: Vec<bool> = support.iter().map(|support| *support >= least).collect();
                prop_assert_eq!(pool.install(|| policy.supported(states.as_view(), least)), supported, "{}", least);
            }
            prop_assert_eq!(certainty.support, support);
            prop_assert_eq!(certainty.deviations, Some(deviations));
        }
    }
}

#[test]
fn an_empty_batch_gives_empty_predictions() {
    let (slope, direct) = fits(&in_context((2, false), 0, (5, 9), 1), Family::Smooth, false);
    let none = DMatrix::zeros(2, 0);
    for policy in [&slope as &dyn LearntPolicy, &direct] {
        assert_eq!(policy.actions(none.as_view()).shape(), (2, 0));
        let certainty = policy.certainty(none.as_view());
        assert_eq!((certainty.support.len(), certainty.deviations.unwrap().shape()), (0, (2, 0)));
        assert_eq!(policy.supported(none.as_view(), 0.5), [false; 0]);
    }
}

/// Ensures that the tests above also evaluate rotation.
#[test]
fn rotating_policies_are_fitted_with_rotation() {
    let (slope, _) = fits(&in_context((2, true), 1, (6, 15), 1), Family::Smooth, true);
    assert!(slope.potential().is_none());
    assert!(slope.formula().terms.iter().any(|term| term.fall == Fall::DivergenceFree));
}

#[test]
#[should_panic(expected = "dimension")]
fn states_of_another_length_are_refused() {
    let (slope, _) = fits(&in_context((2, false), 0, (5, 9), 1), Family::Smooth, false);
    slope.certainty(DMatrix::zeros(3, 4).as_view());
}

/// Far from all rows nothing is known, and all numbers remain valid.
#[test]
fn far_from_all_rows_nothing_is_known() {
    for family in Family::ALL {
        let (slope, direct) = fits(&in_context((2, false), 0, (5, 9), 1), family, false);
        let far = DMatrix::from_column_slice(2, 2, &[1e200, 0.0, f64::MAX, -f64::MAX]);
        for policy in [&slope as &dyn LearntPolicy, &direct] {
            assert_eq!(policy.certainty(far.as_view()).support, [0.0, 0.0], "{family}");
        }
    }
}
