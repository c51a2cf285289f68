//! How much two models differ, and whether one is better by more than chance.

use nalgebra::DMatrix;

/// mean/(sd/√K), sd with K − 1; 0 where nothing varies.
pub(crate) fn t_of_mean(values: &[f64]) -> f64 {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0);
    let t = mean / (variance / count).sqrt();
    if t.is_finite() { t } else { 0.0 }
}

/// Σ|a − b|²/Σ|a − mean a|² over columns.
pub(crate) fn difference(a: &DMatrix<f64>, b: &DMatrix<f64>) -> f64 {
    (a - b).norm_squared() / spread(a)
}

/// Σ|a − mean a|² over columns.
pub(crate) fn spread(a: &DMatrix<f64>) -> f64 {
    let mean = a.column_mean();
    a.column_iter().map(|column| (column - &mean).norm_squared()).sum()
}
