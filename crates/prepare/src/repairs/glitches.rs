//! Glitches: single samples that are far from both neighbours.

use motion::anomalies::long_steps;
use motion::{Episode, Subject, Verdict};
use nalgebra::{DMatrix, DVector};

use crate::notes::Notes;
use crate::numbers::{counted, percent};

/// A glitch is further from its neighbours than this multiple of their distance.
const ALONE: f64 = 4.0;
/// Largest share of an episode's samples that are glitches. If there are more, something else is wrong.
const MOST: f64 = 0.05;
/// Velocities at a glitch contradict the positions if the interpolated ones miss the displacement by less than this share of the error.
const CONFIRMED: f64 = 0.5;

/// Replaces single positions and velocities that are far from both neighbours by the mean of these, and reports it.
pub(crate) fn interpolate(episodes: &mut [Episode], notes: &mut Notes) {
    let samples: usize = episodes.iter().map(Episode::n_samples).sum();
    let positions = episodes.iter_mut().map(interpolate_positions).sum();
    report(positions, ("positions", "position"), samples, notes);
    let velocities = episodes.iter_mut().map(interpolate_velocities).sum();
    report(velocities, ("recorded velocities", "recorded velocity"), samples, notes);
}

fn report(count: usize, (many, one): (&str, &str), samples: usize, notes: &mut Notes) {
    if count == 0 {
        return;
    }
    let (what, verb, them) = if count == 1 { (one, "is", "it was") } else { (many, "are", "they were") };
    let interpolated = format!("{} interpolated", counted(count, "sample"));
    notes.decided(Subject::Jumps, interpolated, format!("{what} far from those before and after"));
    let share = percent(count as f64 / samples as f64);
    notes.found(
        Verdict::Good,
        format!(
            "{count} {what} ({share} of the samples) {verb} far from the samples before and after; {them} interpolated"
        ),
        "check the sensor for glitches (--jumps keep)",
    );
}

/// Returns the number of glitches.
fn interpolate_positions(episode: &mut Episode) -> usize {
    let glitches = glitches(&episode.positions, episode.times.uneven());
    for &sample in &glitches {
        let mean = between(&episode.positions, episode, sample);
        episode.positions.set_column(sample, &mean);
    }
    glitches.len()
}

/// Returns the number of glitches that the positions do not confirm.
fn interpolate_velocities(episode: &mut Episode) -> usize {
    let Some(velocities) = &episode.velocities else { return 0 };
    let mut found = glitches(velocities, episode.times.uneven());
    found.retain(|&sample| {
        let mean = between(velocities, episode, sample);
        let miss = |velocity: DVector<f64>| displacement_error(episode, velocities, sample, &velocity);
        miss(mean) < CONFIRMED * miss(velocities.column(sample).into_owned())
    });
    let means: Vec<DVector<f64>> = found.iter().map(|&sample| between(velocities, episode, sample)).collect();
    if let Some(velocities) = &mut episode.velocities {
        for (&sample, mean) in found.iter().zip(&means) {
            velocities.set_column(sample, mean);
        }
    }
    found.len()
}

/// Samples of a series (n, N) between two long steps, out and back; none if there are too many.
fn glitches(series: &DMatrix<f64>, times: Option<&[f64]>) -> Vec<usize> {
    let long = long_steps(series, times);
    let distance = |a: usize, b: usize| (series.column(a) - series.column(b)).norm();
    let is_alone = |at: usize| {
        let across = distance(at - 1, at + 1);
        distance(at - 1, at).min(distance(at, at + 1)) > ALONE * across
    };
    let pairs = long.windows(2).map(|pair| (pair[0].sample, pair[1].sample));
    let glitches: Vec<usize> =
        pairs.filter(|&(out, back)| back == out + 1 && is_alone(back)).map(|(_, back)| back).collect();
    if glitches.len() as f64 <= MOST * series.ncols() as f64 { glitches } else { Vec::new() }
}

/// The value at the time of a sample on the straight line between its neighbours.
fn between(series: &DMatrix<f64>, episode: &Episode, sample: usize) -> DVector<f64> {
    let whole = episode.times.seconds(sample - 1, sample + 1);
    let share = if whole > 0.0 { episode.times.seconds(sample - 1, sample) / whole } else { 0.5 };
    series.column(sample - 1) * (1.0 - share) + series.column(sample + 1) * share
}

/// Distance of the displacement between the neighbours of a sample from that by velocities, with `velocity` at the sample.
fn displacement_error(episode: &Episode, velocities: &DMatrix<f64>, sample: usize, velocity: &DVector<f64>) -> f64 {
    let [before, after] = [sample, sample + 1].map(|to| episode.times.seconds(to - 1, to));
    let by_velocities = (velocities.column(sample - 1) + velocity) * (0.5 * before)
        + (velocities.column(sample + 1) + velocity) * (0.5 * after);
    (episode.positions.column(sample + 1) - episode.positions.column(sample - 1) - by_velocities).norm()
}
