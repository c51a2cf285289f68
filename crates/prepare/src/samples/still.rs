//! Samples at rest, before a movement begins and after it has ended.

use motion::{Demonstrations, Episode, Finding, Recordings, Verdict};
use nalgebra::DMatrix;

use crate::notes::{Notes, and_more};
use crate::samples::noise;
use crate::scale::range;

/// Minimum number of samples at rest to report.
const STILL: usize = 10;
/// Noise above this share of a channel's spread is as large as the movement itself.
const LOUD: f64 = 0.1;
/// With noise above this share of a channel's spread, slow motion and rest cannot be distinguished.
const QUIET: f64 = 0.0025;
/// A channel is at rest if it changes by less than this share of its spread.
const REST: f64 = 1e-6;

/// Maximum distance of each channel from the first or last sample at rest, (n).
struct Rest {
    bounds: Vec<f64>,
    /// Whether noise is small enough to distinguish rest from slow motion.
    quiet: bool,
}

impl Rest {
    /// `noise`: standard deviation of each channel, (n), if known.
    fn of(demonstrations: &Demonstrations, noise: Option<&[f64]>) -> Rest {
        let spread = |axis: usize| {
            let (low, high) = range(demonstrations.values(axis));
            high - low
        };
        let noise = |axis: usize| noise.map_or(0.0, |noise| noise[axis]);
        let spreads: Vec<f64> = (0..demonstrations.dim()).map(spread).collect();
        let bound = |(axis, spread): (usize, &f64)| (4.0 * noise(axis)).min(LOUD * spread).max(REST * spread);
        let quiet = spreads.iter().enumerate().all(|(axis, spread)| noise(axis) <= QUIET * spread);
        Rest { bounds: spreads.iter().enumerate().map(bound).collect(), quiet }
    }

    /// Numbers of samples at rest at the start and at the end of a movement (n, N).
    fn ends(&self, states: &DMatrix<f64>) -> (usize, usize) {
        let count = |samples: &mut dyn Iterator<Item = usize>| {
            let Some(end) = samples.next() else { return 0 };
            let near = |&i: &usize| {
                (0..self.bounds.len()).all(|k| (states[(k, i)] - states[(k, end)]).abs() <= self.bounds[k])
            };
            let still = samples.take_while(near).count();
            if still < STILL { 0 } else { still }
        };
        let (start, end) = (count(&mut (0..states.ncols())), count(&mut (0..states.ncols()).rev()));
        if start + end < states.ncols() { (start, end) } else { (0, end) }
    }
}

/// Removes samples at rest at either end of every episode (`--trim-still`).
pub fn trim_still(recordings: &mut Recordings) {
    let moving = recordings.episodes.iter().filter_map(|episode| episode.clone().into_trajectory().ok());
    let Ok(demonstrations) = Demonstrations::new(moving.collect()) else { return };
    let rest = Rest::of(&demonstrations, noise::of(&demonstrations).positions.as_deref());
    let (before, mut removed) = (recordings.episodes.iter().map(Episode::n_samples).sum::<usize>(), 0);
    for episode in &mut recordings.episodes {
        let (start, end) = rest.ends(&episode.positions);
        removed += start + end;
        if start + end > 0 {
            *episode = episode.part(start, episode.n_samples() - end);
            let first = episode.times.stamps()[0];
            episode.times.stamps_mut().iter_mut().for_each(|time| *time -= first);
        }
    }
    if removed > 0 {
        recordings.findings.push(Finding::remark(
            format!("{removed} of {before} samples, in which an episode had not begun or had ended, were removed"),
            "without --trim-still they stay",
        ));
    }
}

/// Reports episodes that stand still at an end.
pub(crate) fn remark(
    demonstrations: &Demonstrations,
    noise: Option<&[f64]>,
    (episodes, recorded): (&[String], &Demonstrations),
    notes: &mut Notes,
) {
    let rest = Rest::of(demonstrations, noise);
    let stretches: Vec<(usize, &str, &str)> = episodes
        .iter()
        .zip(recorded.trajectories())
        .flat_map(|(name, movement)| {
            let (start, end) = rest.ends(movement.states());
            [(start, "begins", &name[..]), (end, "ends", &name[..])]
        })
        .filter(|&(samples, ..)| samples > 0)
        .collect();
    if let (Some((samples, verb, name)), true) = (stretches.first(), rest.quiet) {
        notes.found(
            Verdict::Good,
            format!("episode {name} {verb} with {samples} samples at rest{}", and_more(stretches.len())),
            "nothing can be learnt there: --trim-still removes them",
        );
    }
}
