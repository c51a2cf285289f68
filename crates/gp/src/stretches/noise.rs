//! (S20): the noise of velocities, before constraints are known.

use nalgebra::DMatrix;

use crate::Rows;
use crate::stretches::centred;
use motion::upper_median;

/// Sum of the squared coefficients 1, 3, 3, 1 of a third difference.
const THIRD_DIFFERENCE: f64 = 20.0;
/// Number of samples of a window beyond the dimension; its least extent is noise if a constraint acts.
const WINDOW: usize = 5;
/// Quantile of windows: if switches are rare, most windows contain none.
const QUANTILE: f64 = 0.3;
/// Factor by which the least extent of a window may underestimate the noise.
const TIMES: f64 = 3.0;
/// Minimum variance, in mean squares of the velocities, due to rounding.
const ROUNDING: f64 = 1e-14;

/// If velocities differ from sample to sample by less than this share of their known variance, they share their errors, as slopes
/// of smoothed positions do.
const SMOOTH: f64 = 0.25;
/// Number of samples that then share one error.
pub(crate) const SMOOTHED: f64 = 8.0;

/// s², the variance of a velocity along an axis: the smaller of two upper bounds. Third differences also contain the curvature
/// of the motion; the least extent of windows also contains switches and free movement. At least the median of known variances;
/// `None` without four successive samples.
pub(crate) fn velocity_noise(
    velocities: &DMatrix<f64>,
    variances: Option<&[f64]>,
    movements: &[&[usize]],
) -> Option<f64> {
    let from_differences = noise_of_differences(velocities, movements)?;
    let dim = velocities.nrows();
    let extent = |at: &[usize]| least_extent(&velocities.select_columns(at));
    let windows = movements.iter().flat_map(|movement| movement.chunks_exact(dim + WINDOW).map(extent));
    let mut extents: Vec<f64> = windows.collect();
    extents.sort_by(f64::total_cmp);
    let from_windows = extents.get((QUANTILE * extents.len() as f64) as usize).copied().unwrap_or(f64::INFINITY);
    let mean_square = velocities.norm_squared() / velocities.ncols() as f64;
    Some(from_differences.min(TIMES * from_windows).max(ROUNDING * mean_square).max(known_noise(variances)))
}

/// The number of samples that share one error of their velocities.
pub(crate) fn sharing(rows: &Rows, movements: &[&[usize]]) -> f64 {
    let differences = noise_of_differences(rows.velocities(), movements);
    let is_smooth = differences.is_some_and(|differences| differences < SMOOTH * known_noise(rows.variances()));
    if is_smooth { SMOOTHED } else { 1.0 }
}

/// The median of known variances, 0 if none are known.
fn known_noise(variances: Option<&[f64]>) -> f64 {
    variances.and_then(|variances| upper_median(variances.to_vec())).unwrap_or(0.0)
}

/// The variance of a velocity along an axis from third differences, an upper bound; `None` without four successive samples.
fn noise_of_differences(velocities: &DMatrix<f64>, movements: &[&[usize]]) -> Option<f64> {
    let dim = velocities.nrows();
    let velocity = |row: usize| velocities.column(row);
    let third =
        |at: &[usize]| (velocity(at[3]) - velocity(at[0]) + 3.0 * (velocity(at[1]) - velocity(at[2]))).norm_squared();
    let thirds: Vec<f64> = movements.iter().flat_map(|movement| movement.windows(4).map(third)).collect();
    // The median of χ² with n degrees of freedom is about n (1 − 2/9n)³.
    let median_of_chi_squared = dim as f64 * (1.0 - 2.0 / (9.0 * dim as f64)).powi(3);
    Some(upper_median(thirds)? / (THIRD_DIFFERENCE * median_of_chi_squared))
}

/// The least eigenvalue of the centred scatter, per degree of freedom.
fn least_extent(velocities: &DMatrix<f64>) -> f64 {
    let (_, centred) = centred(velocities);
    (&centred * centred.transpose()).symmetric_eigenvalues().min().max(0.0) / WINDOW as f64
}
