//! Relative noise variance of each row: D of (S6).

use crate::{GpError, Rows};

/// Minimum weight: no row counts more than a thousand times as much as the median.
const LEAST: f64 = 1e-3;
/// Maximum assumed length of the policy, in root mean squares of the observed speeds.
const LONGEST: f64 = 3.0;

/// (S2): D of slope rows, from the variance s² of each velocity along an axis, the speeds r and estimates g of the policy's
/// length. A sample whose motion is nearly blocked, r ≪ g, has almost no weight.
pub(crate) fn slope_weights(variances: &[f64], speeds: &[f64], policy_lengths: &[f64]) -> Vec<f64> {
    let floor = 1e-9 * speeds.iter().map(|r| r * r).sum::<f64>() / speeds.len() as f64;
    let each = variances.iter().zip(speeds.iter().zip(policy_lengths));
    relative(each.map(|(s2, (r, g))| s2 * (g / r).max(1.0).powi(2) + floor).collect())
}

/// (S18): D of slope rows with certain velocities, from the speeds r and the length of a policy there. Unmodelled effects,
/// such as a small push or undeclared noise, change slow rows most.
pub(crate) fn certain_weights(speeds: &[f64], policy_lengths: &[f64]) -> Vec<f64> {
    let most = LONGEST * (speeds.iter().map(|r| r * r).sum::<f64>() / speeds.len() as f64).sqrt();
    relative(speeds.iter().zip(policy_lengths).map(|(r, g)| (g.min(most) / r).max(1.0).powi(2)).collect())
}

/// (R1): D of direct rows. The target is the velocity itself, with mean square `unit_squared` per component.
pub(crate) fn direct_weights(variances: &[f64], unit_squared: f64) -> Vec<f64> {
    relative(variances.iter().map(|s2| s2 + 1e-9 * unit_squared).collect())
}

/// Divides by the median.
pub(crate) fn relative(variances: Vec<f64>) -> Vec<f64> {
    let mut sorted = variances.clone();
    sorted.sort_by(f64::total_cmp);
    let middle = sorted.len() / 2;
    let median = if sorted.len() % 2 == 1 { sorted[middle] } else { 0.5 * (sorted[middle - 1] + sorted[middle]) };
    variances.into_iter().map(|variance| (variance / median).max(LEAST)).collect()
}

/// Refuses noise weights that are not one positive number for each row.
pub(crate) fn require_noise_weights(rows: &Rows, noise_weights: &[f64]) -> Result<(), GpError> {
    let (found, expected) = (noise_weights.len(), rows.len());
    if found != expected {
        return Err(GpError::Lengths { what: "noise weights", found, expected });
    }
    require_positive("noise weight", noise_weights)
}

/// Refuses the first value that is not positive and finite.
pub(crate) fn require_positive(what: &'static str, values: &[f64]) -> Result<(), GpError> {
    match values.iter().position(|&value| !(value > 0.0 && value.is_finite())) {
        Some(row) => Err(GpError::Value { what, row, value: values[row] }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// (S18), evaluated literally.
    fn literal(r: &[f64], g: &[f64]) -> Vec<f64> {
        let rms = (r.iter().map(|r| r * r).sum::<f64>() / r.len() as f64).sqrt();
        let tau: Vec<f64> = (0..r.len()).map(|i| (g[i].min(3.0 * rms) / r[i]).max(1.0).powi(2)).collect();
        let mut sorted = tau.clone();
        sorted.sort_by(f64::total_cmp);
        let median = 0.5 * (sorted[(r.len() - 1) / 2] + sorted[r.len() / 2]);
        tau.iter().map(|tau| (tau / median).max(1e-3)).collect()
    }

    proptest! {
        /// The unit of speed does not matter; half of the rows weigh at most 1; if the policy is as long as the observed
        /// velocities, all weights are equal.
        #[test]
        fn certain_weights_are_relative(
            rows in prop::collection::vec((0.01..3.0f64, 0.0..9.0f64), 3..20),
            unit in 0.01..100.0f64,
        ) {
            let (r, g): (Vec<f64>, Vec<f64>) = rows.iter().copied().unzip();
            let weights = certain_weights(&r, &g);
            let expected = literal(&r, &g);
            let scaled = |of: &[f64]| of.iter().map(|value| value * unit).collect::<Vec<f64>>();
            let elsewhere = certain_weights(&scaled(&r), &scaled(&g));
            for i in 0..r.len() {
                prop_assert!((weights[i] - expected[i]).abs() <= 1e-12 * expected[i]);
                prop_assert!((weights[i] - elsewhere[i]).abs() <= 1e-9 * weights[i]);
                prop_assert!(weights[i] >= LEAST);
            }
            prop_assert!(2 * weights.iter().filter(|&&weight| weight <= 1.0).count() >= r.len());
            prop_assert_eq!(certain_weights(&r, &r), vec![1.0; r.len()]);
        }
    }
}
