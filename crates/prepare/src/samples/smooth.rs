//! Smoothing of positions on request.

use motion::{Demonstrations, MotionError, Subject, Trajectory};
use smoothing::{SavitzkyGolay, SmoothingError, slopes};

use crate::PrepareError;
use crate::notes::Notes;
use crate::options::Smoothing;

/// Minimum number of samples in a window: a parabola passes exactly through three.
const LEAST: usize = 5;
/// Number of samples through which a parabola passes.
const PARABOLA: usize = 3;

/// The movements with the requested smoothing; `None` if none was requested.
pub(crate) fn as_requested(
    demonstrations: &Demonstrations,
    smoothing: Smoothing,
    notes: &mut Notes,
) -> Result<Option<Demonstrations>, PrepareError> {
    let window: &dyn Fn(&Trajectory) -> usize = match smoothing {
        Smoothing::Auto => return Ok(None),
        Smoothing::Off => {
            notes.decided(Subject::Smoothing, "none: positions as recorded", "as requested");
            return Ok(Some(demonstrations.clone()));
        }
        Smoothing::Samples(window) => &move |_| window,
        Smoothing::Seconds(seconds) => &move |movement| nearest_odd(seconds / movement.time_step()),
    };
    let episode = |source| PrepareError::Episode { episode: "smoothed".to_owned(), source };
    let smoothed = demonstrations.trajectories().iter().map(|movement| {
        let (window, step) = (window(movement), movement.time_step());
        if window < LEAST || window.is_multiple_of(2) {
            return Err(PrepareError::Smoothing { window, step });
        }
        SavitzkyGolay { window, ..SavitzkyGolay::default() }.smooth_trajectory(movement).map_err(|error| match error {
            SmoothingError::Motion(source) => episode(source),
            _ => PrepareError::Smoothing { window, step },
        })
    });
    let smoothed = Demonstrations::new(smoothed.collect::<Result<_, _>>()?).map_err(episode)?;
    let windows = || demonstrations.trajectories().iter().map(window);
    let value = match (windows().min(), windows().max()) {
        (Some(least), Some(most)) if least < most => format!("positions, windows of {least} to {most} samples"),
        (least, _) => format!("positions, window of {} samples", least.unwrap_or_default()),
    };
    notes.decided(Subject::Smoothing, value, "as requested; local parabolas");
    Ok(Some(smoothed))
}

fn nearest_odd(samples: f64) -> usize {
    // Not a number becomes 1; a number that is too large becomes the largest.
    (((samples - 1.0) / 2.0).round().max(0.0) as usize).saturating_mul(2).saturating_add(1)
}

/// The same movements with velocities that are slopes of the parabola through a sample and its neighbours.
///
/// # Errors
/// If slopes overflow.
pub fn with_slopes(demonstrations: &Demonstrations) -> Result<Demonstrations, MotionError> {
    let with = |movement: &Trajectory| movement.clone().with_velocities(slopes(movement, PARABOLA));
    Demonstrations::new(demonstrations.trajectories().iter().map(with).collect::<Result<_, _>>()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_are_odd() {
        for (samples, expected) in
            [(9.0, 9), (8.4, 9), (7.9, 7), (4.0, 5), (0.2, 1), (-3.0, 1), (f64::NAN, 1), (1e30, usize::MAX)]
        {
            assert_eq!(nearest_odd(samples), expected, "{samples}");
        }
    }
}
