//! Relative noise variance of each row: D of (S6).

/// Least weight: no row is believed more than a thousand times the median.
const LEAST: f64 = 1e-3;

/// (S2): D of slope rows, from the variance s² of each velocity along an axis, the speeds r and what the policy's length
/// g is thought to be there. A sample whose motion is nearly blocked, r ≪ g, says nearly nothing.
pub(crate) fn slope_weights(variances: &[f64], speeds: &[f64], policy_lengths: &[f64]) -> Vec<f64> {
    let floor = 1e-9 * speeds.iter().map(|r| r * r).sum::<f64>() / speeds.len() as f64;
    let each = variances.iter().zip(speeds.iter().zip(policy_lengths));
    relative(each.map(|(s2, (r, g))| s2 * (g / r).max(1.0).powi(2) + floor).collect())
}

/// (R1): D of direct rows; the velocity itself is the target, whose mean square a component is `unit_squared`.
pub(crate) fn direct_weights(variances: &[f64], unit_squared: f64) -> Vec<f64> {
    relative(variances.iter().map(|s2| s2 + 1e-9 * unit_squared).collect())
}

/// In units of the median.
pub(crate) fn relative(variances: Vec<f64>) -> Vec<f64> {
    let mut sorted = variances.clone();
    sorted.sort_by(f64::total_cmp);
    let middle = sorted.len() / 2;
    let median = if sorted.len() % 2 == 1 { sorted[middle] } else { 0.5 * (sorted[middle - 1] + sorted[middle]) };
    variances.into_iter().map(|variance| (variance / median).max(LEAST)).collect()
}
