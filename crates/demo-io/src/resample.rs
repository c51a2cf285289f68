//! Resamples movements at even times.

use nalgebra::{DMatrix, DMatrixView};
use thiserror::Error;

use motion::{Episode, Recordings, Times};

/// Maximum count of numbers, so that a rate in the wrong unit does not fill the memory.
const MOST_NUMBERS: f64 = 1e9;

/// Reasons why recordings cannot be resampled.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ResampleError {
    /// The rate is not valid.
    #[error("{rate} Hz is not a rate; give a positive, finite number")]
    Rate {
        /// The given rate.
        rate: f64,
    },
    /// An episode would have a single sample.
    #[error("episode {episode} lasts {seconds} s, less than a step at {rate} Hz; give a higher rate")]
    Short {
        /// Name of the episode.
        episode: String,
        /// Its duration.
        seconds: f64,
        /// In Hz.
        rate: f64,
    },
    /// There would be too many samples.
    #[error("at {rate} Hz there would be {samples:.1e} samples; give a lower rate")]
    Many {
        /// In Hz.
        rate: f64,
        /// Number of samples of all episodes.
        samples: f64,
    },
}

/// Resamples the movements `rate` times a second, from the first sample of each to the last that fits.
///
/// Positions, and velocities if there are any, follow monotone cubics through the samples (Fritsch and Butland), whose
/// values between two samples never lie beyond either. Learning does not need resampling; it uses the actual times of
/// all steps.
///
/// # Errors
///
/// [`ResampleError`]: an invalid rate, one so low that an episode becomes a single sample, or one so high that memory
/// would not suffice.
pub fn resampled(recordings: &Recordings, rate: f64) -> Result<Recordings, ResampleError> {
    if !(rate > 0.0 && rate.is_finite()) {
        return Err(ResampleError::Rate { rate });
    }
    let samples: f64 = recordings.episodes.iter().map(|episode| 1.0 + episode.times.duration() * rate).sum();
    if samples * recordings.state.len() as f64 > MOST_NUMBERS {
        return Err(ResampleError::Many { rate, samples });
    }
    let episodes = recordings.episodes.iter().map(|episode| along(episode, rate));
    let episodes = episodes.collect::<Result<_, _>>()?;
    Ok(Recordings { state: recordings.state.clone(), episodes, findings: recordings.findings.clone() })
}

fn along(episode: &Episode, rate: f64) -> Result<Episode, ResampleError> {
    if episode.n_samples() < 2 {
        return Ok(episode.clone());
    }
    let seconds = episode.times.duration();
    // Tolerance for rounded stamps, so that the last sample is not lost.
    let steps = (seconds * rate * (1.0 + 1e-9)).floor() as usize;
    if steps == 0 {
        return Err(ResampleError::Short { episode: episode.name.clone(), seconds, rate });
    }
    let times: Vec<f64> = (0..=steps).map(|step| step as f64 / rate).collect();
    let own: Vec<f64> = (0..episode.n_samples()).map(|sample| episode.times.seconds(0, sample)).collect();
    let at_times = |values: &DMatrix<f64>| interpolated(&own, values.as_view(), &times);
    // The last sample at or before a time.
    let before = |time: &f64| own.partition_point(|stamp| stamp <= time).saturating_sub(1);
    Ok(Episode {
        name: episode.name.clone(),
        source: episode.source.clone(),
        positions: at_times(&episode.positions),
        velocities: episode.velocities.as_ref().map(at_times),
        constraint: episode.constraint.as_ref().and_then(|labels| labels.chosen(times.iter().map(before))),
        times: Times::Stamped(times),
        context: episode.context.clone(),
    })
}

/// Interpolates values (n, N) at stamps (N) to other, ascending times (M): (n, M).
fn interpolated(stamps: &[f64], values: DMatrixView<'_, f64>, times: &[f64]) -> DMatrix<f64> {
    let slopes = slopes(stamps, values);
    let mut interval = 0;
    let mut result = DMatrix::zeros(values.nrows(), times.len());
    for (&time, mut column) in times.iter().zip(result.column_iter_mut()) {
        while interval + 2 < stamps.len() && stamps[interval + 1] <= time {
            interval += 1;
        }
        let width = stamps[interval + 1] - stamps[interval];
        let t = ((time - stamps[interval]) / width).clamp(0.0, 1.0);
        // Hermite's basis.
        let (start, end) = ((1.0 + 2.0 * t) * (1.0 - t).powi(2), t * t * (3.0 - 2.0 * t));
        let (leaving, arriving) = (t * (1.0 - t).powi(2) * width, t * t * (t - 1.0) * width);
        for axis in 0..values.nrows() {
            column[axis] = start * values[(axis, interval)]
                + end * values[(axis, interval + 1)]
                + leaving * slopes[(axis, interval)]
                + arriving * slopes[(axis, interval + 1)];
        }
    }
    result
}

/// Slope at every stamp, (n, N): 0 at a turning point, else a weighted harmonic mean of the slopes on both sides.
fn slopes(stamps: &[f64], values: DMatrixView<'_, f64>) -> DMatrix<f64> {
    let last = stamps.len() - 1;
    let width = |i: usize| stamps[i + 1] - stamps[i];
    let secant = |axis: usize, i: usize| (values[(axis, i + 1)] - values[(axis, i)]) / width(i);
    DMatrix::from_fn(values.nrows(), stamps.len(), |axis, i| {
        if last == 1 {
            return secant(axis, 0);
        }
        if i == 0 {
            return at_end((width(0), secant(axis, 0)), (width(1), secant(axis, 1)));
        }
        if i == last {
            return at_end((width(i - 1), secant(axis, i - 1)), (width(i - 2), secant(axis, i - 2)));
        }
        let (before, after) = (secant(axis, i - 1), secant(axis, i));
        if before * after <= 0.0 {
            return 0.0;
        }
        let (left, right) = (2.0 * width(i) + width(i - 1), width(i) + 2.0 * width(i - 1));
        (left + right) / (left / before + right / after)
    })
}

/// Slope at an end: that of the parabola through the outermost three samples, limited to avoid overshoot.
fn at_end((width, secant): (f64, f64), (next_width, next): (f64, f64)) -> f64 {
    let slope = ((2.0 * width + next_width) * secant - width * next) / (width + next_width);
    if slope * secant <= 0.0 {
        0.0
    } else if secant * next <= 0.0 && slope.abs() > 3.0 * secant.abs() {
        3.0 * secant
    } else {
        slope
    }
}

#[cfg(test)]
mod tests;
