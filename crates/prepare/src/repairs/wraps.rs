use std::f64::consts::TAU;

use motion::{Channel, Episode, Subject, Verdict, unwrap_angle};
use nalgebra::DMatrix;

use crate::notes::{Notes, and_more};
use crate::numbers::short;
use crate::scale::range;

/// Only a step longer than this share of a turn shows that an angle wraps.
const WRAP: f64 = 0.75;
/// Angles that wrap come this close to the end of their range, and hardly exceed it.
const RANGE: std::ops::RangeInclusive<f64> = 0.9..=1.02;

/// Unwraps angles that jump by a whole turn. Every movement then ends within half a turn of the common end.
pub(crate) fn unwrap(episodes: &mut [Episode], channels: &[Channel], notes: &mut Notes) {
    for (channel, described) in channels.iter().enumerate() {
        let Some(turn) = turn(episodes, channel) else { continue };
        let mut wraps = episodes.iter().filter_map(|episode| Some((episode, wrap(episode, channel, turn)?)));
        let Some((first, (sample, step))) = wraps.next() else { continue };
        let (place, wrapped) = (first.place(sample), 1 + wraps.count());
        for episode in episodes.iter_mut() {
            unwrapped(episode, channel, turn);
        }
        to_common_end(episodes, channel, turn);
        let name = &described.name;
        notes.decided(
            Subject::Angles,
            format!("{name} unwrapped"),
            format!("it jumps by a whole turn in {} of {} episodes", wrapped, episodes.len()),
        );
        notes.found(
            Verdict::Doubtful,
            format!(
                "channel '{name}' jumps by {}, nearly a whole turn ({place}){}; it was unwrapped",
                short(step),
                and_more(wrapped)
            ),
            "check that all episodes now end at the same place, or choose the angles yourself (--wraps keep --unwrap NAMES)",
        );
    }
}

/// A whole turn in the units of a channel whose values cover one, in radians or degrees.
fn turn(episodes: &[Episode], channel: usize) -> Option<f64> {
    let (low, high) = range(episodes.iter().flat_map(|episode| episode.positions.column_iter().map(|x| x[channel])));
    let fills = |turn: f64| {
        let symmetric = RANGE.contains(&(high / (turn / 2.0))) && RANGE.contains(&(-low / (turn / 2.0)));
        let positive = RANGE.contains(&(high / turn)) && low.abs() < 0.1 * turn;
        symmetric || positive
    };
    [TAU, 360.0].into_iter().find(|&turn| fills(turn))
}

/// The first sample that is a whole turn from the previous one, and the size of the step.
fn wrap(episode: &Episode, channel: usize, turn: f64) -> Option<(usize, f64)> {
    let step = |i: usize| (episode.positions[(channel, i)] - episode.positions[(channel, i - 1)]).abs();
    let at = (1..episode.n_samples()).find(|&i| step(i) > WRAP * turn)?;
    Some((at, step(at)))
}

fn unwrapped(episode: &mut Episode, channel: usize, turn: f64) {
    let Episode { positions, velocities, times, .. } = episode;
    let velocities = velocities.as_mut().map_or_else(Default::default, DMatrix::as_mut_slice);
    let dim = positions.nrows();
    let seconds = |sample: usize| times.seconds(sample - 1, sample);
    unwrap_angle(positions.as_mut_slice(), velocities, (dim, channel), turn, seconds);
}

fn to_common_end(episodes: &mut [Episode], channel: usize, turn: f64) {
    let end = |episode: &Episode| episode.positions[(channel, episode.n_samples() - 1)];
    let (sine, cosine) = episodes.iter().fold((0.0, 0.0), |(sine, cosine), episode| {
        let angle = end(episode) / turn * TAU;
        (sine + angle.sin(), cosine + angle.cos())
    });
    let common = f64::atan2(sine, cosine) / TAU * turn;
    for episode in episodes {
        let turns = ((end(episode) - common) / turn).round();
        episode.positions.row_mut(channel).add_scalar_mut(-turns * turn);
    }
}
