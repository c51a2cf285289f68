//! Size of the policy errors that left-out residuals share (S42).

use nalgebra::DMatrix;

use crate::kernel::covariance::NOISE_FLOOR;
use crate::left_out::LeftOutPredictions;

/// (nᵀn')² above which two rows observe nearly the same component of the policy.
const SAME: f64 = 0.5;

/// γ of (S42): squared errors of the policy on left-out movements divided by the posterior's prediction, from products of successive
/// residuals, which share the policy's error but not their noise. 0 if no two rows of a movement observe the same component.
///
/// `n` are the rows' directions, (n, M), `noise` is σ² without the floor, with the weights D, (M), `groups` the rows of each movement in
/// order of time.
pub(crate) fn common_error(
    left_out: &LeftOutPredictions,
    n: &DMatrix<f64>,
    (noise, noise_weights): (f64, &[f64]),
    groups: &[Vec<usize>],
) -> f64 {
    let LeftOutPredictions { residuals, variances, .. } = left_out;
    let posterior = |row: usize| (variances[row] - (noise + NOISE_FLOOR) * noise_weights[row]).max(0.0);
    // The floor is not actual noise.
    let predictive = |row: usize| posterior(row) + noise * noise_weights[row];
    let (mut found, mut expected) = (0.0, 0.0);
    for rows in groups {
        for (at, &row) in rows.iter().enumerate() {
            let along = |other: usize| n.column(row).dot(&n.column(other));
            let mut near = rows[at + 1..].iter().take(n.nrows()).map(|&other| (other, along(other)));
            let Some((other, along)) = near.find(|(_, along)| along * along >= SAME) else { continue };
            let common = along * (posterior(row) * posterior(other)).sqrt();
            // Least squares: the products vary like products of the predictive variances.
            let weight = common / (predictive(row) * predictive(other));
            found += weight * residuals[(row, 0)] * residuals[(other, 0)];
            expected += weight * common;
        }
    }
    if expected > 0.0 { (found / expected).max(0.0) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use rand::SeedableRng as _;
    use rand_chacha::ChaCha8Rng;

    use super::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]

        /// Policy errors `factor` times as large as the posterior predicts are found, whatever the noise is and whatever the model assumes
        /// for it.
        #[test]
        fn shared_policy_errors_are_estimated(
            factor in 0.01f64..10.0,
            own in 0.0f64..4.0,
            believed in 0.0f64..4.0,
            seed in any::<u64>(),
        ) {
            let rng = &mut ChaCha8Rng::seed_from_u64(seed);
            let (movements, rows) = (2000, 6);
            let count = movements * rows;
            let mut normal = || -> f64 { rng.sample(rand_distr::StandardNormal) };
            let mut residuals = DMatrix::zeros(count, 1);
            for movement in 0..movements {
                let common = factor.sqrt() * normal();
                for row in 0..rows {
                    residuals[(movement * rows + row, 0)] = common + own.sqrt() * normal();
                }
            }
            let n = DMatrix::from_fn(2, count, |k, _| if k == 0 { 1.0 } else { 0.0 });
            let groups: Vec<Vec<usize>> = (0..movements).map(|at| (at * rows..(at + 1) * rows).collect()).collect();
            let left_out = LeftOutPredictions { residuals, variances: vec![1.0 + believed + NOISE_FLOOR; count], r_squared: 0.0, z_squared: 1.0 };
            let found = common_error(&left_out, &n, (believed, &vec![1.0; count]), &groups);
            let deviation = (2.0 * factor.powi(2) + own * (own + 2.0 * factor) / 2.0).sqrt() / (movements as f64).sqrt();
            prop_assert!((found - factor).abs() <= 6.0 * deviation, "{found} {factor}");
        }

        /// Rows that observe orthogonal components, or single rows, contribute nothing; the sign of a direction does not matter.
        #[test]
        fn only_rows_of_one_component_count(values in prop::collection::vec(0.1f64..2.0, 8), flipped in any::<bool>()) {
            let residuals = DMatrix::from_row_slice(8, 1, &values);
            let error = |n: &DMatrix<f64>, residuals: &DMatrix<f64>, groups: &[Vec<usize>]| {
                let left_out =
                    LeftOutPredictions { residuals: residuals.clone(), variances: vec![1.0; 8], r_squared: 0.0, z_squared: 1.0 };
                common_error(&left_out, n, (0.5, &[1.0; 8]), groups)
            };
            let same = DMatrix::from_fn(3, 8, |k, _| if k == 0 { 1.0 } else { 0.0 });
            let turned = DMatrix::from_fn(3, 8, |k, row| if k == row % 2 { 1.0 } else { 0.0 });
            let pairs: Vec<Vec<usize>> = (0..4).map(|at| vec![2 * at, 2 * at + 1]).collect();
            prop_assert_eq!(error(&turned, &residuals, &pairs), 0.0);
            prop_assert_eq!(error(&same, &residuals, &(0..8).map(|row| vec![row]).collect::<Vec<_>>()), 0.0);
            // If a sample has several rows, the partner is the row of the next sample along the same component.
            let all = [(0..8).collect::<Vec<_>>()];
            prop_assert!(error(&turned, &residuals, &all) > 0.0);
            let sign = |row: usize| if flipped && row.is_multiple_of(3) { -1.0 } else { 1.0 };
            let other_signs = DMatrix::from_fn(3, 8, |k, row| sign(row) * same[(k, row)]);
            let other_residuals = DMatrix::from_fn(8, 1, |row, _| sign(row) * residuals[(row, 0)]);
            prop_assert!((error(&same, &residuals, &all) - error(&other_signs, &other_residuals, &all)).abs() < 1e-12);
        }
    }
}
