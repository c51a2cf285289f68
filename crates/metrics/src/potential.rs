use nalgebra::{DMatrixView, DVector};

use crate::MetricsError;
use crate::spread::{representable, spread};

/// Normalised error of a learnt potential (A3): `Σ_n (f_n − φ_n − µ)² / (N σ²_φ)`, where µ is the mean of f − φ, since a
/// potential is known up to a constant only.
///
/// The error of aligned local potentials (A4) is the same, with the samples' own values φ̂ plus their trajectory's offset b in place of f.
///
/// `truth` φ and `learnt` f hold the potentials at N test states. `σ²_φ` is the variance (divided by N) of φ over them.
///
/// # Errors
/// [`MetricsError::Shape`], [`MetricsError::Empty`], [`MetricsError::NotFinite`], [`MetricsError::Overflow`], or
/// [`MetricsError::ConstantTruth`] when σ is at most 1e-12 of the potential's root mean square.
pub fn potential_nmse(truth: &DVector<f64>, learnt: &DVector<f64>) -> Result<f64, MetricsError> {
    let n_samples = truth.len();
    let spread = spread(one_row(truth), one_row(learnt))?;
    let difference = learnt.zip_map(truth, |f, phi| f / spread.unit - phi / spread.unit);
    let offset = difference.mean();
    let squares = difference.map(|d| (d - offset).powi(2));
    representable(squares.sum() / (n_samples as f64 * spread.variance))
}

/// A scalar series (N) as samples in columns, (1, N).
fn one_row(series: &DVector<f64>) -> DMatrixView<'_, f64> {
    DMatrixView::from_slice(series.as_slice(), 1, series.len())
}
