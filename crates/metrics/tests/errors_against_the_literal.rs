//! Compares (A1)–(A4) with literal loops, and checks invariances.

use metrics::{ncpe, npoe, nppe, nupe, potential_nmse};
use nalgebra::{DMatrix, DVector, DVectorViewMut};
use proptest::collection::vec;
use proptest::prelude::*;

/// True and learnt policy (n, N), a rotation of the state space, and the number of basis directions that a constraint
/// forbids at each sample.
#[derive(Debug)]
struct Case {
    truth: DMatrix<f64>,
    learnt: DMatrix<f64>,
    rotation: DMatrix<f64>,
    forbidden: Vec<usize>,
}

impl Case {
    /// An orthogonal projection at each sample, along the rotated axes.
    fn project(&self, sample: usize, mut difference: DVectorViewMut<'_, f64>) {
        for direction in self.rotation.columns(0, self.forbidden[sample]).column_iter() {
            let along = direction.dot(&difference);
            difference.axpy(-along, &direction, 1.0);
        }
    }
}

fn case() -> impl Strategy<Value = Case> {
    (1..5usize, 2..12usize, -3.0..3.0f64).prop_flat_map(|(n, samples, exponent)| {
        let truth = vec(-1.0..1.0f64, n * samples);
        let learnt = vec(-1.0..1.0f64, n * samples);
        (truth, learnt, vec(-1.0..1.0f64, n * n), vec(0..=n, samples)).prop_map(
            move |(truth, learnt, turn, forbidden)| Case {
                truth: DMatrix::from_vec(n, samples, truth),
                learnt: DMatrix::from_vec(n, samples, learnt) * 10f64.powf(exponent),
                rotation: DMatrix::from_vec(n, n, turn).qr().q(),
                forbidden,
            },
        )
    })
}

/// Trace of the covariance, entry by entry.
fn variance(truth: &DMatrix<f64>) -> f64 {
    let samples = truth.ncols() as f64;
    let mut trace = 0.0;
    for dimension in 0..truth.nrows() {
        let mean = truth.row(dimension).iter().sum::<f64>() / samples;
        for sample in 0..truth.ncols() {
            trace += (truth[(dimension, sample)] - mean).powi(2) / samples;
        }
    }
    trace
}

fn assert_close(found: f64, expected: f64) -> Result<(), TestCaseError> {
    prop_assert!((found - expected).abs() <= 1e-10 * expected.abs(), "found {}, expected {}", found, expected);
    Ok(())
}

proptest! {
    /// Compares nPPE and nPOE with their literal sums, with other constraints as estimates.
    #[test]
    fn errors_of_constraints_are_the_literal_sums(case in case()) {
        let forbidden = case.forbidden.iter().rev().copied().collect();
        let rotation = case.rotation.transpose();
        let estimated = Case { truth: case.truth.clone(), learnt: case.learnt.clone(), rotation, forbidden };
        let policy = &case.truth;
        prop_assume!(variance(policy) > 1e-6);
        let (mut projected, mut observed) = (0.0, 0.0);
        for sample in 0..policy.ncols() {
            let (mut right, mut wrong) = (policy.column(sample).into_owned(), policy.column(sample).into_owned());
            case.project(sample, right.as_view_mut());
            estimated.project(sample, wrong.as_view_mut());
            projected += (right - &wrong).norm_squared();
            observed += (policy.column(sample) - wrong).norm_squared();
        }
        let scale = policy.ncols() as f64 * variance(policy);
        let by = |of: &Case, sample, vector: DVectorViewMut<'_, f64>| of.project(sample, vector);
        let nppe_of = |learnt| nppe(policy, |i, v| by(&case, i, v), |i, v| by(learnt, i, v)).unwrap();
        prop_assert!((nppe_of(&estimated) - projected / scale).abs() <= 1e-10 * (1.0 + projected / scale));
        prop_assert!((npoe(policy, |i, v| by(&estimated, i, v)).unwrap() - observed / scale).abs() <= 1e-10 * (1.0 + observed / scale));
        prop_assert_eq!(nppe_of(&case), 0.0);
    }

    #[test]
    fn policy_errors_are_the_literal_sums(case in case()) {
        let (truth, learnt) = (&case.truth, &case.learnt);
        prop_assume!(variance(truth) > 1e-6);
        let (mut free, mut constrained) = (0.0, 0.0);
        for sample in 0..truth.ncols() {
            let mut difference = truth.column(sample) - learnt.column(sample);
            free += difference.norm_squared();
            case.project(sample, difference.as_view_mut());
            constrained += difference.norm_squared();
        }
        let scale = truth.ncols() as f64 * variance(truth);
        let (nupe, ncpe) = (nupe(truth, learnt).unwrap(), ncpe(truth, learnt, |sample, d| case.project(sample, d)).unwrap());
        assert_close(nupe, free / scale)?;
        prop_assert!((ncpe - constrained / scale).abs() <= 1e-10 * nupe);
        prop_assert!(ncpe <= nupe * (1.0 + 1e-12));
    }

    #[test]
    fn potential_errors_are_the_literal_sums(case in case()) {
        let (truth, learnt) = (case.truth.row(0).transpose(), case.learnt.row(0).transpose());
        let samples = truth.len() as f64;
        let (mut phi_mean, mut offset) = (0.0, 0.0);
        for sample in 0..truth.len() {
            phi_mean += truth[sample] / samples;
            offset += (learnt[sample] - truth[sample]) / samples;
        }
        let (mut spread, mut error) = (0.0, 0.0);
        for sample in 0..truth.len() {
            spread += (truth[sample] - phi_mean).powi(2);
            error += (learnt[sample] - truth[sample] - offset).powi(2);
        }
        prop_assume!(spread > 1e-6);
        assert_close(potential_nmse(&truth, &learnt).unwrap(), error / spread)?;
    }

    #[test]
    fn agreement_is_zero_and_the_best_constant_is_one(case in case(), constant in -9.0..9.0f64) {
        let (truth, samples) = (&case.truth, case.truth.ncols());
        prop_assume!(variance(truth) > 1e-6);
        prop_assert_eq!(nupe(truth, truth).unwrap(), 0.0);
        let mean = DMatrix::from_fn(truth.nrows(), samples, |dimension, _| truth.row(dimension).mean());
        assert_close(nupe(truth, &mean).unwrap(), 1.0)?;

        let phi = truth.row(0).transpose();
        prop_assume!(phi.variance() > 1e-6);
        prop_assert_eq!(potential_nmse(&phi, &phi).unwrap(), 0.0);
        assert_close(potential_nmse(&phi, &DVector::repeat(samples, constant)).unwrap(), 1.0)?;
    }

    #[test]
    fn errors_are_invariant_to_units_axes_and_order(
        case in case(), exponent in -290.0..290.0f64, velocity in vec(-2.0..2.0f64, 4), turn in 0..11usize,
    ) {
        let (truth, learnt) = (&case.truth, &case.learnt);
        prop_assume!(variance(truth) > 1e-6);
        let (free, under) = (nupe(truth, learnt).unwrap(), ncpe(truth, learnt, |sample, d| case.project(sample, d)).unwrap());
        // Other units.
        let unit = 10f64.powf(exponent);
        assert_close(nupe(&(truth * unit), &(learnt * unit)).unwrap(), free)?;
        let scaled = ncpe(&(truth * unit), &(learnt * unit), |sample, d| case.project(sample, d)).unwrap();
        prop_assert!((scaled - under).abs() <= 1e-10 * free);
        // Other axes.
        assert_close(nupe(&(&case.rotation * truth), &(&case.rotation * learnt)).unwrap(), free)?;
        // Another order of the samples.
        let order = |policy: &DMatrix<f64>| {
            DMatrix::from_fn(policy.nrows(), policy.ncols(), |i, sample| policy[(i, (sample + turn) % policy.ncols())])
        };
        assert_close(nupe(&order(truth), &order(learnt)).unwrap(), free)?;
        // A moving observer.
        let seen = |policy: &DMatrix<f64>| DMatrix::from_fn(policy.nrows(), policy.ncols(), |i, sample| policy[(i, sample)] - velocity[i]);
        let moving = nupe(&seen(truth), &seen(learnt)).unwrap();
        prop_assert!((moving - free).abs() <= 1e-8 * free.max(1.0));
    }

    #[test]
    fn a_potential_is_known_up_to_a_constant(
        case in case(), exponent in -290.0..290.0f64, ours in -100.0..100.0f64, theirs in -100.0..100.0f64,
    ) {
        let (truth, learnt) = (case.truth.row(0).transpose(), case.learnt.row(0).transpose());
        prop_assume!(truth.variance() > 1e-6);
        let expected = potential_nmse(&truth, &learnt).unwrap();
        let unit = 10f64.powf(exponent);
        assert_close(potential_nmse(&(&truth * unit), &(&learnt * unit)).unwrap(), expected)?;
        let shifted = potential_nmse(&truth.add_scalar(theirs), &learnt.add_scalar(ours)).unwrap();
        // A shift of 100 causes rounding errors of 1e-14, compared with a deviation of at least 1e-3.
        prop_assert!((shifted - expected).abs() <= 1e-9 * expected.max(1.0));
    }
}
