//! A constant offset of recorded velocities: a sensor whose zero is wrong, or a commanded press.

use motion::{Channel, Episode, Verdict};
use nalgebra::DVector;

use crate::notes::Notes;
use crate::numbers::short;
use crate::repairs::displacements::displacements;

/// Minimum number of movements.
const LEAST: usize = 5;
/// Minimum offset of a channel, in standard deviations of its mean over movements, …
const SURE: f64 = 8.0;
/// … and as a share of the channel's root mean square velocity.
const SHARE: f64 = 0.05;

/// A constant by which recorded velocities exceed the steps in every movement, (n); `None` if there is none.
pub(super) fn of(episodes: &[Episode]) -> Option<DVector<f64>> {
    let excesses: Vec<DVector<f64>> = episodes.iter().filter_map(excess).collect();
    if excesses.len() < LEAST {
        return None;
    }
    let square_speed = |axis: usize| {
        let of_movement = |episode: &Episode| episode.velocities.as_ref().map_or(0.0, |u| u.row(axis).norm_squared());
        episodes.iter().map(of_movement).sum::<f64>() / episodes.iter().map(Episode::n_samples).sum::<usize>() as f64
    };
    let of_axis = |axis: usize, _| {
        let (count, values) = (excesses.len() as f64, excesses.iter().map(|excess| excess[axis]));
        let mean = values.clone().sum::<f64>() / count;
        let variance = values.map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0);
        let sure = mean * mean * count > SURE * SURE * variance && mean * mean > variance;
        if sure && mean * mean > SHARE * SHARE * square_speed(axis) { mean } else { 0.0 }
    };
    let offset = DVector::from_fn(excesses[0].len(), of_axis);
    (offset.amax() > 0.0).then_some(offset)
}

/// Subtracts it from all velocities.
pub(super) fn subtract(episodes: &mut [Episode], offset: &DVector<f64>) {
    for velocities in episodes.iter_mut().filter_map(|episode| episode.velocities.as_mut()) {
        velocities.column_iter_mut().for_each(|mut velocity| velocity -= offset);
    }
}

/// Reports that a constant was subtracted.
pub(super) fn report(offset: &DVector<f64>, channels: &[Channel], notes: &mut Notes) {
    let of_channels = channels.iter().zip(offset).filter(|(_, offset)| **offset != 0.0);
    let each: Vec<String> =
        of_channels.map(|(channel, offset)| format!("{} by {}", channel.name, short(*offset))).collect();
    notes.found(
        Verdict::Doubtful,
        format!("recorded velocities exceed the steps by a constant ({}); it was subtracted", each.join(", ")),
        "check the zero of the velocity sensor, or record measured instead of commanded velocities (--integration displacement)",
    );
}

/// Mean velocity minus displacement per second of a movement, (n).
fn excess(episode: &Episode) -> Option<DVector<f64>> {
    let (velocities, last) = (episode.velocities.as_ref()?, episode.n_samples() - 1);
    let seconds = episode.times.seconds(0, last);
    if seconds <= 0.0 {
        return None;
    }
    let (moved, integral) = displacements(episode, velocities, 0..last);
    Some((integral - moved) / seconds)
}
