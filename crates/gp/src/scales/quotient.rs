//! (S25): the scales with the least left-out error, from the errors of each axis.

use nalgebra::{DMatrix, DVector};

use crate::evidence::Evidence;
use crate::evidence::lbfgs::{Bounds, Curvature, Limits, minimise};

/// Limit on |log m|: for an axis that hardly moves, larger values are not better determined.
const MOST: f64 = 14.0;
/// Determines the logarithm of the quotient to nine digits.
const LIMITS: Limits = Limits { iterations: 200, tolerance: 2.2e-9 };

/// m ≥ 0, (n), with the least mᵀEm / mᵀYm. The search starts from equal entries and from the generalised eigenvectors;
/// the result has geometric mean 1.
pub(super) fn least_error(errors: &DMatrix<f64>, targets: &DMatrix<f64>) -> DVector<f64> {
    let dim = errors.nrows();
    let bounds = Bounds { lower: DVector::repeat(dim, -MOST), upper: DVector::repeat(dim, MOST) };
    let objective = |log: &DVector<f64>| quotient(errors, targets, log);
    let starts = std::iter::once(DVector::zeros(dim)).chain(eigenvectors(errors, targets));
    let ends = starts.map(|start| minimise(objective, &start, &bounds, LIMITS, &mut Curvature::default()));
    let value = |log: &DVector<f64>| objective(log).map_or(f64::INFINITY, |of| of.value);
    let best = ends.min_by(|a, b| value(a).total_cmp(&value(b))).unwrap_or_else(|| DVector::zeros(dim));
    let middle = best.mean();
    best.map(|log| (log - middle).exp())
}

/// log(mᵀEm / mᵀYm) and its gradient with respect to log m.
fn quotient(errors: &DMatrix<f64>, targets: &DMatrix<f64>, log: &DVector<f64>) -> Option<Evidence> {
    let m = log.map(f64::exp);
    let (left, all) = (errors * &m, targets * &m);
    let (numerator, denominator) = (m.dot(&left), m.dot(&all));
    let value = (numerator / denominator).ln();
    let gradient = DVector::from_fn(m.len(), |k, _| 2.0 * m[k] * (left[k] / numerator - all[k] / denominator));
    value.is_finite().then_some(Evidence { value, gradient })
}

/// log |v| of E v = λ Y v.
fn eigenvectors(errors: &DMatrix<f64>, targets: &DMatrix<f64>) -> Vec<DVector<f64>> {
    let Some(factor) = targets.clone().cholesky() else { return Vec::new() };
    let lower = factor.l();
    let Some(half) = lower.solve_lower_triangular(errors) else { return Vec::new() };
    let Some(whole) = lower.solve_lower_triangular(&half.transpose()) else { return Vec::new() };
    let vectors = whole.symmetric_eigen().eigenvectors;
    let back = lower.tr_solve_lower_triangular(&vectors);
    let log = |v: nalgebra::DVectorView<'_, f64>| (v.map(f64::abs) / v.amax()).map(|v| v.max(1e-6).ln());
    back.map_or_else(Vec::new, |vectors| vectors.column_iter().map(log).collect())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;

    /// Products XᵀX of random matrices.
    fn products(dim: usize, seed: u64) -> (DMatrix<f64>, DMatrix<f64>) {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut product = || {
            let x = DMatrix::from_fn(3 * dim, dim, |_, _| rng.random::<f64>());
            x.tr_mul(&x)
        };
        (product(), product())
    }

    proptest! {
        #[test]
        fn gradients_are_differences(dim in 1usize..6, seed in any::<u64>(), at in -2.0..2.0f64) {
            let (errors, targets) = products(dim, seed);
            let log = DVector::from_fn(dim, |k, _| at * (k as f64 + 0.5).sin());
            let gradient = quotient(&errors, &targets, &log).unwrap().gradient;
            for k in 0..dim {
                let value = |by: f64| {
                    let mut log = log.clone();
                    log[k] += by;
                    quotient(&errors, &targets, &log).unwrap().value
                };
                prop_assert!(((value(1e-5) - value(-1e-5)) / 2e-5 - gradient[k]).abs() < 1e-7);
            }
        }

        /// If the error vanishes for one m, that m is found, whatever its size.
        #[test]
        fn scales_without_error_are_found(dim in 2usize..6, seed in any::<u64>()) {
            let (targets, _) = products(dim, seed);
            let m = DVector::from_fn(dim, |k, _| (1.3 * (seed as f64 * 1e-18 + k as f64).sin()).exp());
            // m spans the null space of the errors.
            let along = &m / m.norm();
            let errors = DMatrix::identity(dim, dim) - &along * along.transpose() + 1e-12 * DMatrix::identity(dim, dim);
            let found = least_error(&errors, &targets);
            let middle = m.map(f64::ln).mean().exp();
            prop_assert!((found - m / middle).amax() < 1e-3);
        }
    }
}
