//! Movements of which constraints deflect only some (R10).

use crate::drawn::{matrix, nupe, rng, vector};
use gp::{AutoFit, AutoGp, DirectGp, Hypothesis, Rows, SlopeGp};
use motion::{Policy as _, SampleIndex};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

const MOVEMENTS: usize = 20;
const SAMPLES: usize = 10;

/// Rotation about an axis, towards the origin. Without constraints, uᵀπ = uᵀu also holds for π + Sπ with any antisymmetric S.
fn turning(x: &DVector<f64>) -> DVector<f64> {
    DVector::from_vec(vec![-x[0] - 2.0 * x[1], 2.0 * x[0] - x[1], -0.5 * x[2]])
}

/// Scattered rows of movements; those with a normal are constrained to the plane across it.
fn rows(normals: &[Option<DVector<f64>>], seed: u64) -> Rows {
    let rng = &mut rng(seed);
    let states = DMatrix::from_columns(&(0..normals.len() * SAMPLES).map(|_| vector(3, rng)).collect::<Vec<_>>());
    let velocity = |row: usize| {
        let policy = turning(&states.column(row).into_owned());
        normals[row / SAMPLES].as_ref().map_or_else(|| policy.clone(), |n| &policy - n * n.dot(&policy))
    };
    let velocities = DMatrix::from_columns(&(0..states.ncols()).map(velocity).collect::<Vec<_>>());
    let index = |row: usize| SampleIndex { trajectory: row / SAMPLES, sample: row % SAMPLES };
    let indices = (0..states.ncols()).map(index).collect();
    Rows::new(states, velocities, indices).expect("finite rows")
}

fn normal(seed: u64) -> DVector<f64> {
    vector(3, &mut rng(seed)).normalize()
}

fn learner() -> AutoGp {
    let slope = SlopeGp { max_rows: 200, hyper_rows: 100, ..SlopeGp::default() };
    AutoGp { slope, ..AutoGp::default() }
}

fn fit(learner: &AutoGp, rows: &Rows, seed: u64) -> AutoFit {
    learner.fit(rows, &mut rng(seed)).expect("a fit")
}

fn error(fit: &AutoFit) -> f64 {
    let states = matrix(3, 50, &mut rng(7));
    let truth = DMatrix::from_columns(&states.column_iter().map(|x| turning(&x.into_owned())).collect::<Vec<_>>());
    nupe(fit, &(states, truth))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6))]

    /// Whichever movements are constrained, the others are found to the row, and the policy with them.
    #[test]
    fn free_movements_are_found(constrained in prop::collection::btree_set(0..MOVEMENTS, 1..7), seed in any::<u64>()) {
        let normals: Vec<_> =
            (0..MOVEMENTS).map(|at| constrained.contains(&at).then(|| normal(seed ^ at as u64))).collect();
        let given = rows(&normals, seed);
        let fit = fit(&learner(), &given, seed);
        let free = fit.numbers().free.expect("free rows");
        let of_free = 1.0 - constrained.len() as f64 / MOVEMENTS as f64;
        prop_assert!((free.share - of_free).abs() < 1e-12, "{free:?} {constrained:?}");
        let found = fit.free_rows(&given);
        prop_assert!(found.indices().iter().all(|index| !constrained.contains(&index.trajectory)));
        prop_assert_eq!(found.len(), (MOVEMENTS - constrained.len()) * SAMPLES);
        prop_assert_eq!(fit.reading(), Hypothesis::Constrained);
        prop_assert!(!fit.takes_slope() && error(&fit) < 1e-9, "{} {:?}", error(&fit), fit.numbers());
        prop_assert!(error(&fit) <= fit.expected_nupe().max(1e-9), "{:?}", fit.numbers());
    }

    /// One constraint in most movements looks like free motion; the others contradict it, because they move across.
    #[test]
    fn a_common_constraint_is_not_free_motion(others in 4_usize..8, seed in any::<u64>()) {
        let normals: Vec<_> =
            (0..MOVEMENTS).map(|at| Some(normal(if at < others { seed ^ (at as u64 + 1) } else { seed }))).collect();
        let fit = fit(&learner(), &rows(&normals, seed), seed);
        prop_assert_eq!(fit.numbers().free, None);
        prop_assert!(fit.takes_slope() && error(&fit) < 1e-6, "{} {:?}", error(&fit), fit.numbers());
    }
}

/// One constrained movement in twenty: the slope GP alone predicts left-out movements, but not the policy.
fn one_constrained() -> Rows {
    let mut normals = vec![None; MOVEMENTS];
    normals[4] = Some(normal(3));
    rows(&normals, 1)
}

#[test]
fn the_other_two_policies_do_not_change() {
    let (rows, learner) = (one_constrained(), learner());
    let [with, without] = [true, false].map(|free_rows| fit(&AutoGp { free_rows, ..learner.clone() }, &rows, 1));
    assert!(with.numbers().free.is_some() && without.numbers().free.is_none());
    let direct = DirectGp { max_rows: 200, hyper_rows: 100, ..DirectGp::default() };
    let alone = direct.fit(&rows, &mut rng(1)).expect("a fit");
    for x in rows.states().column_iter() {
        assert_eq!(with.direct().action(x), without.direct().action(x));
        assert_eq!(with.direct().action(x), alone.action(x));
        assert_eq!(with.slope().action(x), without.slope().action(x));
    }
    assert!(error(&with) < 1e-9 && error(&without) > 1e-6, "{} {}", error(&with), error(&without));
    assert!(with.slope().report().expected_nupe >= with.numbers().gap, "the free rows show the slope GP's error");
}

#[test]
fn a_given_reading_is_not_searched_for_free_rows() {
    for reading in [Hypothesis::Free, Hypothesis::Constrained] {
        let fit = fit(&AutoGp { reading: Some(reading), ..learner() }, &one_constrained(), 1);
        assert_eq!((fit.numbers().free, fit.takes_slope()), (None, reading == Hypothesis::Constrained));
    }
}

#[test]
fn a_stored_fit_keeps_the_policy_of_free_rows() {
    let rows = one_constrained();
    let fit = fit(&learner(), &rows, 1);
    let read: AutoFit = serde_json::from_str(&serde_json::to_string(&fit).expect("JSON")).expect("a fit");
    assert_eq!(read.numbers(), fit.numbers());
    assert_eq!(read.free_rows(&rows).indices(), fit.free_rows(&rows).indices());
    for x in rows.states().column_iter() {
        assert_eq!(read.action(x), fit.action(x));
        assert_eq!(read.action(x), fit.direct_of_free_rows().action(x));
    }
}
