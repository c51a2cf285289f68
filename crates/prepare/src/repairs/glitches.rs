//! Glitches: positions far from both neighbours, and velocities unlike the steps beside them.

use motion::anomalies::{long_steps, stands_out};
use motion::{Channel, Episode, Subject, Verdict, upper_median};
use nalgebra::{DMatrix, DVector};

use crate::notes::Notes;
use crate::numbers::{counted, percent, short};

/// A glitch is further from its neighbours than this multiple of their distance.
const ALONE: f64 = 4.0;
/// Largest share of an episode's samples that are glitches. If there are more, something else is wrong.
const MOST: f64 = 0.2;
/// A velocity is a glitch if it contradicts the steps beside it by this share of the median speed.
const SHARE: f64 = 0.2;
/// The interpolated velocity must contradict the steps by at most this share of the recorded one's error.
const CONFIRMED: f64 = 0.3;

/// Replaces positions that are far from both neighbours, and velocities that contradict the steps before and after, by values on the straight
/// line between the samples beside them, and reports it.
pub(crate) fn interpolate(episodes: &mut [Episode], channels: &[Channel], notes: &mut Notes) {
    let far = ["positions are", "position is"].map(|what| format!("{what} far from the samples before and after"));
    let unlike = ["recorded velocities are", "recorded velocity is"]
        .map(|what| format!("{what} unlike the steps before and after"));
    repair(episodes, interpolate_positions, (&far, channels), notes);
    repair(episodes, interpolate_velocities, (&unlike, channels), notes);
}

/// An interpolated sample, and the difference of the recorded value from it, (n).
type Glitch = (usize, DVector<f64>);

/// Interpolates the glitches of all episodes, and reports their number and the first one.
fn repair(
    episodes: &mut [Episode],
    interpolate: impl Fn(&mut Episode) -> Vec<Glitch>,
    ([many, one], channels): (&[String; 2], &[Channel]),
    notes: &mut Notes,
) {
    let (mut count, mut samples, mut first) = (0, 0, None);
    for episode in episodes {
        let glitches = interpolate(episode);
        (count, samples) = (count + glitches.len(), samples + episode.n_samples());
        if let (None, Some((sample, off))) = (&first, glitches.first()) {
            first = Some(format!(
                "{}: '{}' by {}",
                episode.place(*sample),
                channels[off.icamax()].name,
                short(off[off.icamax()])
            ));
        }
    }
    let Some(first) = first else { return };
    let (what, them) = if count == 1 { (one, "it was") } else { (many, "they were") };
    let share = percent(count as f64 / samples as f64);
    notes.decided(Subject::Jumps, format!("{} interpolated", counted(count, "sample")), format!("{count} {what}"));
    notes.found(
        Verdict::Good,
        format!("{count} {what} ({share} of the samples; {first}); {them} interpolated"),
        "check the sensor for glitches (--jumps keep)",
    );
}

/// Positions that are far from both neighbours.
fn interpolate_positions(episode: &mut Episode) -> Vec<Glitch> {
    let found = glitches(&episode.positions, episode.times.uneven());
    let interpolate = |sample: usize| {
        let mean = between(&episode.positions, episode, (sample - 1, sample, sample + 1));
        let off = episode.positions.column(sample) - &mean;
        episode.positions.set_column(sample, &mean);
        (sample, off)
    };
    found.into_iter().map(interpolate).collect()
}

/// Velocities that contradict both steps beside them.
fn interpolate_velocities(episode: &mut Episode) -> Vec<Glitch> {
    let Some(velocities) = &episode.velocities else { return Vec::new() };
    let errors = step_errors(episode, velocities);
    let speeds = velocities.column_iter().map(|velocity| velocity.norm()).collect();
    let (Some(usual), Some(speed)) = (upper_median(errors.clone()), upper_median(speeds)) else {
        return Vec::new();
    };
    let is_glitch = |&at: &usize| errors[at] > SHARE * speed && stands_out(&errors, at, usual);
    let (glitches, good): (Vec<usize>, Vec<usize>) = (0..errors.len()).partition(is_glitch);
    if glitches.is_empty() || glitches.len() as f64 > MOST * errors.len() as f64 {
        return Vec::new();
    }
    let mut interpolated = velocities.clone();
    for &at in &glitches {
        let next = good.partition_point(|&other| other < at);
        let (before, after) = (good[next.saturating_sub(1)], good[next.min(good.len() - 1)]);
        interpolated.set_column(at, &between(velocities, episode, (before, at, after)));
    }
    // Where a velocity changes fast, both contradict the steps.
    let left = step_errors(episode, &interpolated);
    let off = |at: usize| (at, velocities.column(at) - interpolated.column(at));
    let confirmed: Vec<Glitch> =
        glitches.into_iter().filter(|&at| left[at] < CONFIRMED * errors[at]).map(off).collect();
    if let Some(velocities) = &mut episode.velocities {
        for (at, _) in &confirmed {
            velocities.set_column(*at, &interpolated.column(*at));
        }
    }
    confirmed
}

/// For each sample the smaller difference, of the steps before and after it, between the displacement per second and the mean velocity of the
/// step. Where a constraint switches, one of them is small.
fn step_errors(episode: &Episode, velocities: &DMatrix<f64>) -> Vec<f64> {
    let error = |from: usize| {
        let seconds = episode.times.seconds(from, from + 1);
        let of_axis = |axis: usize| {
            let displacement = episode.positions[(axis, from + 1)] - episode.positions[(axis, from)];
            let mean = f64::midpoint(velocities[(axis, from)], velocities[(axis, from + 1)]);
            (displacement / seconds - mean).powi(2)
        };
        (0..velocities.nrows()).map(of_axis).sum::<f64>().sqrt()
    };
    let steps: Vec<f64> = (1..episode.n_samples()).map(|to| error(to - 1)).collect();
    let beside = |at: usize| {
        steps[at.saturating_sub(1)..(at + 1).min(steps.len())].iter().copied().fold(f64::INFINITY, f64::min)
    };
    (0..episode.n_samples()).map(beside).collect()
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

/// The value at the time of a sample on the straight line between two others, or that of the only one.
fn between(series: &DMatrix<f64>, episode: &Episode, (before, at, after): (usize, usize, usize)) -> DVector<f64> {
    if before >= after {
        return series.column(after).into_owned();
    }
    let share = episode.times.seconds(before, at) / episode.times.seconds(before, after);
    series.column(before) * (1.0 - share) + series.column(after) * share
}
