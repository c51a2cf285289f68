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

/// Normalised constrained policy error (A2): `Σ_n ‖N_n (π_n − π̂_n)‖² / (N σ²_π)`. As in [`nupe`], σ² is that of the true
/// policy without constraints.
///
/// `project(sample, difference)` replaces a vector (n) by its projection through the constraint at that sample. It is called
/// once for each sample, in order, and must be linear: the difference is in units of the largest true value.
///
/// # Errors
/// As [`nupe`], and [`MetricsError::NotFinite`] for the result of `project`.
pub fn ncpe(
    truth: &DMatrix<f64>,
    learnt: &DMatrix<f64>,
    mut project: impl FnMut(usize, DVectorViewMut<'_, f64>),
) -> Result<f64, MetricsError> {
    projected_error(truth, learnt, &mut project)
}

/// Normalised projected policy error: `Σ_n ‖N_n π_n − N̂_n π_n‖² / (N σ²_π)`, the error of estimated projectors N̂ of
/// constraints (Lin, Howard, Vijayakumar, "Learning null space projections", ICRA 2015).
///
/// `policy` is the true policy at N samples, (n, N); `truth` and `learnt` replace a vector (n) by its projection through the
/// true and the estimated constraint at a sample, as `project` of [`ncpe`] does.
///
/// # Errors
/// As [`ncpe`].
pub fn nppe(
    policy: &DMatrix<f64>,
    mut truth: impl FnMut(usize, DVectorViewMut<'_, f64>),
    mut learnt: impl FnMut(usize, DVectorViewMut<'_, f64>),
) -> Result<f64, MetricsError> {
    let mut other = DVector::zeros(policy.nrows());
    ncpe(policy, &DMatrix::zeros(policy.nrows(), policy.ncols()), |sample, mut action| {
        other.copy_from(&action);
        learnt(sample, other.as_view_mut());
        truth(sample, action.as_view_mut());
        action -= &other;
    })
}

/// Normalised projected observation error: `Σ_n ‖u_n − N̂_n u_n‖² / (N σ²_u)`. It is the part that estimated projectors N̂ of
/// constraints remove from observed velocities u, (n, N), which the true projectors leave unchanged (Lin, Howard, Vijayakumar,
/// ICRA 2015). It does not need the truth. `learnt` is as in [`nppe`], σ² as in [`nupe`].
///
/// # Errors
/// As [`ncpe`].
pub fn npoe(
    velocities: &DMatrix<f64>,
    learnt: impl FnMut(usize, DVectorViewMut<'_, f64>),
) -> Result<f64, MetricsError> {
    nppe(velocities, |_sample, _velocity| {}, learnt)
}

/// [`ncpe`] without a type parameter, compiled once for all projections.
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
