use nalgebra::{DMatrix, DVector, DVectorViewMut};

use crate::spread::{representable, spread};
use crate::{MetricsError, Series};

/// Normalised unconstrained policy error (A1): `Σ_n ‖π_n − π̂_n‖² / (N σ²_π)`.
///
/// `truth` and `learnt` hold the true and the learnt policy at N test states as columns, (n, N). `σ²_π` is the trace of the
/// covariance (divided by N) of the true policy over these states.
///
/// # Errors
/// [`MetricsError::Shape`], [`MetricsError::Empty`], [`MetricsError::NotFinite`], [`MetricsError::Overflow`], or
/// [`MetricsError::ConstantTruth`] when σ is at most 1e-12 of the policy's root mean square.
pub fn nupe(truth: &DMatrix<f64>, learnt: &DMatrix<f64>) -> Result<f64, MetricsError> {
    ncpe(truth, learnt, |_sample, _difference| {})
}

/// Normalised constrained policy error (A2): `Σ_n ‖N_n (π_n − π̂_n)‖² / (N σ²_π)`, with σ² as in [`nupe`]: of the true
/// policy without any constraint.
///
/// `project(sample, difference)` replaces a vector (n) by its projection through the constraint at that sample. It is called
/// once for each sample, in order, and must be linear: the difference comes in units of the largest true value.
///
/// # Errors
/// As [`nupe`], and [`MetricsError::NotFinite`] for what `project` leaves.
pub fn ncpe(
    truth: &DMatrix<f64>,
    learnt: &DMatrix<f64>,
    mut project: impl FnMut(usize, DVectorViewMut<'_, f64>),
) -> Result<f64, MetricsError> {
    projected_error(truth, learnt, &mut project)
}

/// [`ncpe`], compiled here for every projection.
fn projected_error(
    truth: &DMatrix<f64>,
    learnt: &DMatrix<f64>,
    project: &mut dyn FnMut(usize, DVectorViewMut<'_, f64>),
) -> Result<f64, MetricsError> {
    let spread = spread(truth.as_view(), learnt.as_view())?;
    let mut sum = 0.0;
    let mut difference = DVector::zeros(truth.nrows());
    for sample in 0..truth.ncols() {
        for dimension in 0..truth.nrows() {
            let at = (dimension, sample);
            difference[dimension] = representable(truth[at] / spread.unit - learnt[at] / spread.unit)?;
        }
        project(sample, difference.as_view_mut());
        if let Some(dimension) = difference.iter().position(|value| !value.is_finite()) {
            let value = difference[dimension];
            return Err(MetricsError::NotFinite { series: Series::Projected, sample, dimension, value });
        }
        sum += difference.norm_squared();
    }
    representable(sum / (truth.ncols() as f64 * spread.variance))
}
