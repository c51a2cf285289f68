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
/// Share of the squared bend of a polynomial about a sample below which one beside it does not hold the switch that it holds: its
/// errors by curvature are six times larger at most.
const JUMP: f64 = 0.01;

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
    // What recorded velocities agree with at most samples: a simulator that takes Euler steps moves along them, all else along slopes.
    // Where a constraint switches both may be far off, so that samples count, not squares.
    let nearer = |movement: &Trajectory| -> Vec<bool> {
        let Some(recorded) = movement.velocities() else { return Vec::new() };
        let (steps, slopes) = (recorded - steps(movement), recorded - slopes(movement));
        steps.column_iter().zip(slopes.column_iter()).map(|(step, slope)| step.norm() < slope.norm()).collect()
    };
    let nearer: Vec<bool> = demonstrations.trajectories().iter().flat_map(nearer).collect();
    let of_steps = nearer.iter().filter(|&&step| step).count();
    let velocities = if 2 * of_steps > nearer.len() { steps } else { slopes };
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
/// power of the time between them. Where a constraint switches among those, through samples before or after it.
fn slopes(movement: &Trajectory) -> DMatrix<f64> {
    let (states, count) = (movement.states(), movement.n_samples());
    let points = POINTS.min(count);
    let time = |first: usize, k: usize| movement.seconds(first, first + k);
    // Highest divided difference of the samples from each on: it tells a jump of the velocity.
    let bend = |first: usize| {
        let weight = |k: usize| {
            let apart = |j: usize| time(first, k) - time(first, j);
            (0..points).filter(|&j| j != k).map(apart).product::<f64>().recip()
        };
        let of = |k: usize| (states.column(first + k) - states.column(first)) * weight(k);
        (1..points).map(of).sum::<DVector<f64>>().norm_squared()
    };
    let bends: Vec<f64> = (0..=count - points).map(bend).collect();
    let half = points / 2;
    let mut slopes = DMatrix::zeros(states.nrows(), count);
    for sample in 0..count {
        let nearest = sample.saturating_sub(half).min(count - points);
        let beside = nearest.saturating_sub(half)..=(nearest + half).min(count - points);
        let beside = beside.filter(|first| (*first..*first + points).contains(&sample));
        let smooth = beside.min_by(|a, b| bends[*a].total_cmp(&bends[*b]));
        let first = smooth.filter(|&first| bends[first] < JUMP * bends[nearest]).unwrap_or(nearest);
        let at = |k: usize| time(first, k);
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

    /// Of samples so far apart.
    fn times(steps: &[f64]) -> Vec<f64> {
        (0..=steps.len()).map(|count| steps[..count].iter().sum()).collect()
    }

    proptest! {
        /// Where two movements of the third degree meet, slopes are those of one of both where they meet, and exact elsewhere.
        #[test]
        fn slopes_about_a_switch_are_exact(
            before in prop::array::uniform3(-2.0..2.0f64),
            after in prop::array::uniform3(-2.0..2.0f64),
            jump in 0.1..2.0f64,
            steps in prop::collection::vec(0.05..0.3f64, 8..20),
            switch in 4usize..16,
        ) {
            let (times, switch) = (times(&steps), switch.min(steps.len() - 4));
            let after = [before[0] + jump, after[1], after[2]];
            let at = |sample: usize| {
                let (t, [a, b, c]) = (times[sample] - times[switch], if sample < switch { before } else { after });
                (a * t + b * t * t + c * t.powi(3), a + 2.0 * b * t + 3.0 * c * t * t)
            };
            let states = DMatrix::from_fn(2, times.len(), |axis, i| at(i).0 * (axis as f64 + 1.0));
            let movement = Trajectory::new(states, 1.0).and_then(|of| of.with_times(times.clone())).expect("a movement");
            for (sample, found) in slopes(&movement).column_iter().enumerate() {
                let near = |slope: f64| (found[0] - slope).abs() < 1e-7 && (found[1] - 2.0 * slope).abs() < 1e-7;
                let either = sample == switch && near(before[0]);
                prop_assert!(near(at(sample).1) || either, "{found} {} at {sample}, switch {switch}", at(sample).1);
            }
        }

        /// Slopes of polynomials up to the fourth degree are exact at any times, and of fewer samples those of lower degrees.
        #[test]
        fn slopes_of_polynomials_are_exact(
            coefficients in prop::array::uniform5(-2.0..2.0f64),
            steps in prop::collection::vec(0.05..0.3f64, 1..20),
        ) {
            let times = times(&steps);
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
