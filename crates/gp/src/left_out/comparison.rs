//! Measures how much two models differ, and whether one is better by more than chance.

use motion::{mean_and_error, spread};
use nalgebra::DMatrix;

/// mean/(sd/√K), sd with K − 1; 0 if nothing varies.
pub(crate) fn t_of_mean(values: &[f64]) -> f64 {
    let (mean, error) = mean_and_error(values);
    let t = mean / error;
    if t.is_finite() { t } else { 0.0 }
}

/// ε of (R7) and (S18): errors below this share count as none.
pub(crate) const NEGLIGIBLE: f64 = 1e-4;
/// Two models count as different if their policies differ by more than this share.
pub(crate) const DIFFERS: f64 = 0.05;
/// Minimum t of the mean gain per trajectory for one model to be better than another by more than chance.
pub(crate) const LEAST_T: f64 = 2.5;
/// Maximum share of the left-out error that the better model may leave.
const LEFT: f64 = 0.5;

/// log((E + εR)/(E' + εR)) of one movement: the reduction from error E to E', both relative to R.
pub(crate) fn log_ratio(before: f64, after: f64, all: f64) -> f64 {
    let least = NEGLIGIBLE * all;
    ((before + least) / (after + least)).ln()
}

/// t of the mean gain per trajectory, if it exceeds chance and at most half of the left-out error 1 − R² remains. Units or a metric
/// other than the recorded ones must fulfil this condition.
pub(crate) fn much_better(gains: &[f64], (before, after): (f64, f64)) -> Option<f64> {
    let t = t_of_mean(gains);
    (t >= LEAST_T && after <= LEFT * before).then_some(t)
}

/// Σ|a − b|²/Σ|a − mean a|² over columns.
pub(crate) fn difference(a: &DMatrix<f64>, b: &DMatrix<f64>) -> f64 {
    (a - b).norm_squared() / spread(a)
}
