//! Velocities from positions, if these give less noise than the recorded velocities have.

use motion::{Demonstrations, MotionError, Trajectory};
use nalgebra::{DMatrix, DMatrixView, DVector};
use smoothing::slopes_between_switches;

/// Number of samples of the polynomial whose slope serves as velocity.
const POINTS: usize = 5;
/// Share of the samples whose slopes meet the error estimate.
const GOOD: f64 = 0.9;
/// A slope's squared error is less than this share of the squared fourth difference of the steps around it: noise of positions
/// contributes 0.69 of 70 step variances, curvature 1/900.
const OFF: f64 = 0.01;

/// The movements with velocities from positions, and the noise variance of these per axis; `None` unless it is below `variance`, that
/// of the recorded velocities.
///
/// # Errors
/// If velocities overflow.
pub fn with_less_noise(
    demonstrations: &Demonstrations,
    variance: f64,
) -> Result<Option<(Demonstrations, f64)>, MotionError> {
    let movements = demonstrations.trajectories();
    let mut squares: Vec<f64> = movements.iter().flat_map(squared_fourth_differences).collect();
    squares.sort_by(f64::total_cmp);
    let most = squares.get((GOOD * squares.len() as f64) as usize);
    let of_slopes = most.map(|most| OFF * most / demonstrations.dim() as f64);
    let Some(of_slopes) = of_slopes.filter(|of_slopes| *of_slopes < variance) else { return Ok(None) };
    // Takes what recorded velocities agree with at most samples: steps for a simulator that takes Euler steps, slopes for everything
    // else. Near a switch of the constraint both may be far off, so samples are counted instead of summing squares.
    let slopes = |movement: &Trajectory| slopes_between_switches(movement, POINTS);
    let nearer = |movement: &Trajectory| -> Vec<bool> {
        let Some(recorded) = movement.velocities() else { return Vec::new() };
        let (steps, slopes) = (recorded - steps(movement), recorded - slopes(movement));
        steps.column_iter().zip(slopes.column_iter()).map(|(step, slope)| step.norm() < slope.norm()).collect()
    };
    let nearer: Vec<bool> = movements.iter().flat_map(nearer).collect();
    let of_steps = nearer.iter().filter(|&&step| step).count();
    let with = |movement: &Trajectory| {
        let velocities = if 2 * of_steps > nearer.len() { steps(movement) } else { slopes(movement) };
        movement.clone().with_velocities(velocities)
    };
    let movements = movements.iter().map(with).collect::<Result<_, _>>();
    Ok(Some((movements.and_then(Demonstrations::new)?, of_slopes)))
}

fn squared_fourth_differences(movement: &Trajectory) -> Vec<f64> {
    let steps = movement.step_velocities();
    let fourth =
        |of: DMatrixView<'_, f64>| (of * DVector::from_column_slice(&[1.0, -4.0, 6.0, -4.0, 1.0])).norm_squared();
    (0..(steps.ncols() + 1).saturating_sub(POINTS)).map(|at| fourth(steps.columns(at, POINTS))).collect()
}

/// At each sample, the step that begins there, divided by its duration; at the last sample, the step that ends there, (n, N).
fn steps(movement: &Trajectory) -> DMatrix<f64> {
    let steps = movement.step_velocities();
    let last = steps.ncols();
    DMatrix::from_fn(steps.nrows(), last + 1, |axis, at| steps[(axis, at.min(last - 1))])
}
