//! Smoothing of positions as requested by the user.

use motion::{Demonstrations, MotionError, Trajectory};
use nalgebra::DMatrix;
use smoothing::{SavitzkyGolay, SmoothingError};

use crate::PrepareError;
use crate::notes::Notes;
use crate::options::Smoothing;

/// Fewer samples in a window than this smooth nothing: a parabola goes through three.
const LEAST: usize = 5;

/// The movements as requested; none if nothing was.
pub(crate) fn as_requested(
    demonstrations: &Demonstrations,
    smoothing: Smoothing,
    notes: &mut Notes,
) -> Result<Option<Demonstrations>, PrepareError> {
    let step = demonstrations.trajectories()[0].time_step();
    let window = match smoothing {
        Smoothing::Auto => return Ok(None),
        Smoothing::Off => {
            notes.decided("smoothing", "none: positions as recorded", "as requested", "--smooth");
            return Ok(Some(demonstrations.clone()));
        }
        Smoothing::Samples(window) => window,
        Smoothing::Seconds(seconds) => nearest_odd(seconds / step),
    };
    if window < LEAST || window.is_multiple_of(2) {
        return Err(PrepareError::Smoothing { window, step });
    }
    let smoothed = SavitzkyGolay { window, ..SavitzkyGolay::default() }.smooth(demonstrations);
    let smoothed = smoothed.map_err(|error| match error {
        SmoothingError::Motion(source) => PrepareError::Episode { episode: "smoothed".to_owned(), source },
        _ => PrepareError::Smoothing { window, step },
    })?;
    let value = format!("positions, window of {window} samples");
    notes.decided("smoothing", value, "as requested; local parabolas", "--smooth");
    Ok(Some(smoothed))
}

fn nearest_odd(samples: f64) -> usize {
    // As a cast, what is no number of samples becomes none or very many.
    2 * ((samples - 1.0) / 2.0).round().max(0.0) as usize + 1
}

/// The same movements; velocities are slopes of the parabola through a sample and its neighbours.
///
/// # Errors
/// Where slopes overflow.
pub fn with_slopes(demonstrations: &Demonstrations) -> Result<Demonstrations, MotionError> {
    let with = |movement: &Trajectory| movement.clone().with_velocities(slopes(movement));
    Demonstrations::new(demonstrations.trajectories().iter().map(with).collect::<Result<_, _>>()?)
}

/// (n, N).
fn slopes(movement: &Trajectory) -> DMatrix<f64> {
    let steps = movement.step_velocities();
    let last = steps.ncols() - 1;
    let seconds = |step: usize| movement.seconds(step, step + 1);
    // The slope at a time between two steps' middles, and a little beyond at the ends, lies on the line through theirs.
    let slope = |axis: usize, sample: usize| {
        if last == 0 {
            return steps[(axis, 0)];
        }
        let before = sample.saturating_sub(1).min(last - 1);
        let (h, k) = (seconds(before), seconds(before + 1));
        let (s, t) = (steps[(axis, before)], steps[(axis, before + 1)]);
        let curve = (t - s) / (h + k);
        match sample - before {
            0 => s - h * curve,
            1 => s + h * curve,
            _ => t + k * curve,
        }
    };
    DMatrix::from_fn(steps.nrows(), last + 2, slope)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_of_parabolas_are_exact() {
        for times in [vec![0.0, 0.1, 0.2, 0.3], vec![0.0, 0.3, 0.4, 1.0, 1.5], vec![0.0, 2.0, 3.0], vec![1.0, 2.0]] {
            let degree = if times.len() > 2 { 1.0 } else { 0.0 };
            let at = |t: f64| [1.0 - 2.0 * t + degree * 3.0 * t * t, 0.5 * t];
            let states = DMatrix::from_fn(2, times.len(), |axis, i| at(times[i])[axis]);
            let movement = Trajectory::new(states, 1.0).unwrap().with_times(times.clone()).unwrap();
            let slopes = slopes(&movement);
            for (i, t) in times.iter().enumerate() {
                assert!((slopes[(0, i)] - (-2.0 + degree * 6.0 * t)).abs() < 1e-12, "{times:?} {i}");
                assert!((slopes[(1, i)] - 0.5).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn windows_are_odd() {
        for (samples, expected) in [(9.0, 9), (8.4, 9), (7.9, 7), (4.0, 5), (0.2, 1), (-3.0, 1), (f64::NAN, 1)] {
            assert_eq!(nearest_odd(samples), expected, "{samples}");
        }
    }
}
