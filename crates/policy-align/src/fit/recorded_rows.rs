use gp::{FrontEnd, GpError, Rows};
use motion::{Demonstrations, MotionError, Trajectory};
use nalgebra::{DMatrix, DMatrixView, DVector};
use prepare::{thinned, with_slopes};

use crate::{Prepared, VelocitySource};

/// The rows that the Gaussian processes learn from.
pub(crate) fn rows(prepared: &Prepared) -> Result<Rows, GpError> {
    let demonstrations = averaged(prepared)?;
    let demonstrations = match prepared.velocities {
        VelocitySource::PositionsAsRequested => with_slopes(&demonstrations).map_err(|error| cleaning(&error))?,
        _ => demonstrations,
    };
    front_end(prepared.velocities).rows(&demonstrations)
}

/// Samples whose polynomial has the slope that is taken for a velocity.
const POINTS: usize = 5;
/// Share of the samples whose slopes are as good as is said of all.
const GOOD: f64 = 0.9;
/// A slope's error, squared, is less than this share of the squared fourth difference of the steps around it: by noise of positions
/// 0.69 of 70 step variances, by curvature 1/900.
const OFF: f64 = 0.01;

/// The rows that constraints are found on: where velocities were recorded with noise, slopes of the positions if these have less.
pub(crate) fn least_noisy_rows(prepared: &Prepared) -> Result<Rows, GpError> {
    let VelocitySource::Noisy(variance) = prepared.velocities else { return rows(prepared) };
    let demonstrations = averaged(prepared)?;
    let differences = |movement: &Trajectory| -> Vec<f64> {
        let steps = movement.step_velocities();
        let fourth =
            |of: DMatrixView<'_, f64>| (of * DVector::from_column_slice(&[1.0, -4.0, 6.0, -4.0, 1.0])).norm_squared();
        (0..(steps.ncols() + 1).saturating_sub(POINTS)).map(|at| fourth(steps.columns(at, POINTS))).collect()
    };
    let mut squares: Vec<f64> = demonstrations.trajectories().iter().flat_map(differences).collect();
    squares.sort_by(f64::total_cmp);
    let most = squares.get((GOOD * squares.len() as f64) as usize);
    let of_slopes = most.map(|most| OFF * most / demonstrations.dim() as f64);
    let Some(of_slopes) = of_slopes.filter(|of_slopes| *of_slopes < variance) else { return rows(prepared) };
    // What the recorded velocities agree with: a simulator that takes Euler steps moves along them, all else along slopes.
    let off = |of: fn(&Trajectory) -> DMatrix<f64>| -> f64 {
        let apart = |movement: &Trajectory| movement.velocities().map_or(0.0, |u| (u - of(movement)).norm_squared());
        demonstrations.trajectories().iter().map(apart).sum()
    };
    let velocities = if off(steps) < off(slopes) { steps } else { slopes };
    let with = |movement: &Trajectory| movement.clone().with_velocities(velocities(movement));
    let movements = demonstrations.trajectories().iter().map(with).collect::<Result<_, _>>();
    let demonstrations = movements.and_then(Demonstrations::new).map_err(|error| cleaning(&error))?;
    FrontEnd::NoisyVelocities { variance: of_slopes }.rows(&demonstrations)
}

/// At every sample the step that begins there, over its time, and at the last one the step that ends there, (n, N).
fn steps(movement: &Trajectory) -> DMatrix<f64> {
    let steps = movement.step_velocities();
    let last = steps.ncols();
    DMatrix::from_fn(steps.nrows(), last + 1, |axis, at| steps[(axis, at.min(last - 1))])
}

/// At every sample the slope of the polynomial through it and the samples nearest to it, (n, N): at even times exact to the fourth
/// power of the time between them.
fn slopes(movement: &Trajectory) -> DMatrix<f64> {
    let (states, count) = (movement.states(), movement.n_samples());
    let points = POINTS.min(count);
    let mut slopes = DMatrix::zeros(states.nrows(), count);
    for sample in 0..count {
        let first = sample.saturating_sub(points / 2).min(count - points);
        let at = |k: usize| movement.seconds(first, first + k);
        let (now, own) = (at(sample - first), sample - first);
        // Weights of Lagrange's polynomials, differentiated at one of their points.
        for k in (0..points).filter(|&k| k != own) {
            let others = (0..points).filter(|&j| j != k && j != own);
            let weight = others.map(|j| (now - at(j)) / (at(k) - at(j))).product::<f64>() / (at(k) - now);
            let apart = (states.column(first + k) - states.column(sample)) * weight;
            let mut slope = slopes.column_mut(sample);
            slope += apart;
        }
    }
    slopes
}

/// The front end that makes rows of a Gaussian process from what was recorded.
fn front_end(velocities: VelocitySource) -> FrontEnd {
    match velocities {
        VelocitySource::Recorded | VelocitySource::PositionsAsRequested => FrontEnd::Velocities,
        VelocitySource::Noisy(variance) => FrontEnd::NoisyVelocities { variance },
        VelocitySource::Fused => FrontEnd::Fused(smoothing::Fusion::default()),
        VelocitySource::Positions => FrontEnd::Smoothed(smoothing::Smoother::default()),
    }
}

/// The movements with samples averaged as decided.
pub(crate) fn averaged(prepared: &Prepared) -> Result<Demonstrations, GpError> {
    thinned(&prepared.demonstrations, prepared.averaged).map_err(|error| cleaning(&error))
}

pub(crate) fn cleaning(error: &MotionError) -> GpError {
    GpError::Cleaning { reason: error.to_string() }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// Slopes of polynomials up to the fourth degree are exact at any times, and of fewer samples those of lower degrees.
        #[test]
        fn slopes_of_polynomials_are_exact(
            coefficients in prop::array::uniform5(-2.0..2.0f64),
            steps in prop::collection::vec(0.05..0.3f64, 1..20),
        ) {
            let times: Vec<f64> =
                std::iter::once(0.0).chain(steps.iter().scan(0.0, |t, step| { *t += step; Some(*t) })).collect();
            let degree = times.len().min(POINTS) - 1;
            let of = |t: f64| (0..=degree).map(|k| coefficients[k] * t.powf(k as f64)).sum::<f64>();
            let slope = |t: f64| (1..=degree).map(|k| k as f64 * coefficients[k] * t.powf(k as f64 - 1.0)).sum::<f64>();
            let states = DMatrix::from_fn(2, times.len(), |axis, i| of(times[i]) * (axis as f64 + 1.0));
            let movement = Trajectory::new(states, 1.0).and_then(|of| of.with_times(times.clone())).expect("a movement");
            for (sample, found) in slopes(&movement).column_iter().enumerate() {
                for axis in 0..2 {
                    let expected = slope(times[sample]) * (axis as f64 + 1.0);
                    prop_assert!((found[axis] - expected).abs() < 1e-7 * (1.0 + expected.abs()), "{found} {expected}");
                }
            }
        }
    }
}
