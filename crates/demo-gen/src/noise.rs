use motion::MotionError;
use nalgebra::{DMatrix, DVector};
use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

use crate::{DemoGenError, Recording};

/// The same movements, observed with Gaussian noise: each dimension of each true state gets noise of `share` times
/// that dimension's standard deviation (divided by the number of samples) over all true states. Observed velocities and the
/// truth do not change.
///
/// Draws one number from the generator for each value, by trajectory and sample, whatever the share:
/// the same seed gives the same noise, scaled.
///
/// # Errors
/// [`DemoGenError::NoiseShare`], [`DemoGenError::NoTrajectory`], or [`DemoGenError::Motion`] if the recordings do not
/// share one state space.
pub fn with_position_noise<R: Rng + ?Sized>(
    recordings: &[Recording],
    share: f64,
    rng: &mut R,
) -> Result<Vec<Recording>, DemoGenError> {
    if !(share.is_finite() && share >= 0.0) {
        return Err(DemoGenError::NoiseShare { share });
    }
    let deviation = share * standard_deviation(recordings)?;
    let noisy = recordings.iter().map(|recording| {
        let states = &recording.truth.states;
        let noise = DMatrix::from_fn(states.nrows(), states.ncols(), |dimension, _| {
            deviation[dimension] * rng.sample::<f64, _>(StandardNormal)
        });
        let mut observed = recording.observed.with_states(states + noise)?;
        if let Some(velocities) = recording.observed.velocities() {
            observed = observed.with_velocities(velocities.clone())?;
        }
        Ok(Recording { observed, truth: recording.truth.clone() })
    });
    noisy.collect()
}

/// The same movements with white noise on the observed velocities, of equal variance in all dimensions: the mean of |u|² over all
/// samples is `decibels` above that of the noise. Observed states and the truth do not change.
///
/// Draws one number from the generator for each value, by trajectory and sample, whatever the ratio.
///
/// # Errors
/// [`DemoGenError::SignalToNoise`], [`DemoGenError::NoTrajectory`], or [`DemoGenError::NoVelocities`].
pub fn with_velocity_noise<R: Rng + ?Sized>(
    recordings: &[Recording],
    decibels: f64,
    rng: &mut R,
) -> Result<Vec<Recording>, DemoGenError> {
    if !decibels.is_finite() {
        return Err(DemoGenError::SignalToNoise { decibels });
    }
    let velocities = observed_velocities(recordings)?;
    let power: f64 = velocities.iter().map(|u| u.norm_squared()).sum();
    let count: usize = velocities.iter().map(|u| u.len()).sum();
    let deviation = (power / count as f64 * 10f64.powf(-decibels / 10.0)).sqrt();
    let noisy = recordings.iter().zip(velocities).map(|(recording, u)| {
        let noisy = u.map(|value| value + deviation * rng.sample::<f64, _>(StandardNormal));
        Ok(Recording { observed: recording.observed.clone().with_velocities(noisy)?, truth: recording.truth.clone() })
    });
    noisy.collect()
}

fn observed_velocities(recordings: &[Recording]) -> Result<Vec<&DMatrix<f64>>, DemoGenError> {
    if recordings.is_empty() {
        return Err(DemoGenError::NoTrajectory);
    }
    let each = recordings.iter().enumerate();
    each.map(|(trajectory, recording)| recording.observed.velocities().ok_or(DemoGenError::NoVelocities { trajectory }))
        .collect()
}

/// The standard deviation of each dimension over all true states of a data set, (n).
fn standard_deviation(recordings: &[Recording]) -> Result<DVector<f64>, DemoGenError> {
    let expected = recordings.first().ok_or(DemoGenError::NoTrajectory)?.truth.states.nrows();
    let found = recordings.iter().map(|recording| recording.truth.states.nrows());
    if let Some((trajectory, found)) = found.enumerate().find(|&(_, found)| found != expected) {
        return Err(MotionError::Dimensions { trajectory, found, expected }.into());
    }
    let states = || recordings.iter().flat_map(|recording| recording.truth.states.column_iter());
    let n_samples = states().count() as f64;
    let mean = states().fold(DVector::zeros(expected), |sum, state| sum + state) / n_samples;
    let squares = states().fold(DVector::zeros(expected), |sum, state| sum + (state - &mean).map(|d| d * d));
    Ok((squares / n_samples).map(f64::sqrt))
}
