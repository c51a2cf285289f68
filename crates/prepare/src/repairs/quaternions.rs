//! Orientations as unit quaternions; q and −q are the same orientation.

use motion::{Channel, Episode, Subject, Verdict, standard_deviation};
use nalgebra::{DVectorView, Vector4};

use crate::notes::Notes;
use crate::numbers::counted;
use crate::options::Repair;

/// Tolerance for the norm of a unit quaternion.
const UNIT: f64 = 1e-3;
/// Noisy quaternions: their norms deviate from 1 by at most this, as a root mean square …
const NOISY: f64 = 0.02;
/// … and by this share of the spread along their mean, which is that of a sphere; the distance of a plane from 0 does not vary.
const SPHERE: f64 = 0.5;
/// A step longer than this is a change of sign; opposite quaternions are 2 apart.
const FLIP: f64 = 1.0;

/// If the norm of three channels is nearer to 1 than this share of the deviation of four, the fourth is another quantity: a position beside a
/// row of a rotation matrix.
const NEEDLESS: f64 = 0.5;

/// Reports channels that are unit quaternions, and gives each orientation a consistent sign.
pub(crate) fn align(episodes: &mut [Episode], channels: &[Channel], repair: Repair, notes: &mut Notes) {
    for first in quaternions(episodes, channels.len()) {
        let flips = if repair == Repair::Auto { same_signs(episodes, first) } else { 0 };
        let names: Vec<&str> = channels[first..first + 4].iter().map(|channel| channel.name.as_str()).collect();
        report_signs(&names.join(", "), flips, notes);
    }
}

/// The first channel of each quaternion, in order. Of overlapping windows the one counts whose norm is nearest to 1.
fn quaternions(episodes: &[Episode], n_channels: usize) -> Vec<usize> {
    let windows = 0..(n_channels + 1).saturating_sub(4);
    let mut candidates: Vec<(f64, usize)> =
        windows.filter_map(|first| Some((deviation_of_quaternion(episodes, first)?, first))).collect();
    candidates.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut found: Vec<usize> = Vec::new();
    for (_, first) in candidates {
        if found.iter().all(|other| first.abs_diff(*other) >= 4) {
            found.push(first);
        }
    }
    found.sort_unstable();
    found
}

/// Root mean square of |q| − 1 for four channels, or for three of them.
fn deviation(episodes: &[Episode], first: usize, without: Option<usize>) -> f64 {
    let columns = || episodes.iter().flat_map(|episode| episode.positions.column_iter());
    let norm = |x: DVectorView<'_, f64>| {
        (0..4).filter(|&at| Some(at) != without).map(|at| x[first + at].powi(2)).sum::<f64>().sqrt()
    };
    let squares: f64 = columns().map(|x| (norm(x) - 1.0).powi(2)).sum();
    (squares / columns().count() as f64).sqrt()
}

fn report_signs(names: &str, flips: usize, notes: &mut Notes) {
    let repaired = if flips == 0 {
        String::new()
    } else {
        let flips = counted(flips, "change");
        let why = format!("{flips} of sign, but q and −q are one orientation");
        notes.decided(Subject::Quaternions, format!("{names} with one sign"), why);
        format!(" with {flips} of sign, which were undone")
    };
    notes.found(
        Verdict::Doubtful,
        format!("channels {names} are a unit quaternion{repaired}"),
        "a policy of four free numbers leaves the sphere of orientations: record a rotation vector from the goal's orientation (three channels), or leave them out with --ignore",
    );
}

/// The deviation of four channels whose norm is 1 throughout, up to noise, and that move; `None` for others.
fn deviation_of_quaternion(episodes: &[Episode], first: usize) -> Option<f64> {
    let moves = episodes.iter().any(|episode| {
        let part = episode.positions.rows(first, 4);
        part.column_iter().any(|q| q != part.column(0))
    });
    let columns = || episodes.iter().flat_map(|episode| episode.positions.column_iter());
    let is_unit = |q: DVectorView<'_, f64>| (q.rows(first, 4).norm() - 1.0).abs() <= UNIT;
    let is_quaternion = moves
        && (columns().all(is_unit) || is_noisy_quaternion(columns().map(|x| x.fixed_rows::<4>(first).into_owned())));
    if !is_quaternion {
        return None;
    }
    let of_four = deviation(episodes, first, None);
    let needless = |at: usize| deviation(episodes, first, Some(at)) < NEEDLESS * of_four;
    (!(0..4).any(needless)).then_some(of_four)
}

fn is_noisy_quaternion(all: impl Iterator<Item = Vector4<f64>> + Clone) -> bool {
    let count = all.clone().count() as f64;
    // q and −q are the same: signs must not add to the spread.
    let Some(reference) = all.clone().next() else { return false };
    if all.clone().any(|q| (q.norm() - 1.0).abs() > 5.0 * NOISY) {
        return false;
    }
    let signed = all.map(|q| if q.dot(&reference) < 0.0 { -q } else { q });
    let mean = signed.clone().sum::<Vector4<f64>>().normalize();
    let along = standard_deviation(signed.clone().map(|q| q.dot(&mean)));
    let off = (signed.map(|q| (q.norm() - 1.0).powi(2)).sum::<f64>() / count).sqrt();
    off <= NOISY.min(SPHERE * along)
}

/// Makes signs consistent; returns the number of sign changes, within movements and between them.
fn same_signs(episodes: &mut [Episode], first: usize) -> usize {
    let reference = episodes[0].positions.fixed_view::<4, 1>(first, 0).into_owned();
    let mut flips = 0;
    for episode in episodes {
        let (mut before, mut sign) = (reference, 1.0);
        for i in 0..episode.n_samples() {
            let q = episode.positions.fixed_view::<4, 1>(first, i).into_owned();
            let now = if before.dot(&q) < 0.0 { -1.0 } else { 1.0 };
            if now != sign {
                flips += 1;
                sign = now;
            }
            before = q * sign;
            episode.positions.fixed_view_mut::<4, 1>(first, i).copy_from(&before);
            if let Some(velocities) = &mut episode.velocities {
                velocities.fixed_view_mut::<4, 1>(first, i).scale_mut(sign);
            }
        }
        make_of_positions(episode, first);
    }
    flips
}

/// Recomputes velocities that were computed from the positions, because they jump with them.
fn make_of_positions(episode: &mut Episode, first: usize) {
    let Some(velocities) = &mut episode.velocities else { return };
    for i in 1..episode.positions.ncols() {
        let seconds = episode.times.seconds(i - 1, i);
        let q = |at: usize| episode.positions.fixed_view::<4, 1>(first, at).into_owned();
        for sample in [i - 1, i] {
            let mut velocity = velocities.fixed_view_mut::<4, 1>(first, sample);
            if velocity.norm() * seconds > FLIP {
                velocity.copy_from(&((q(i) - q(i - 1)) / seconds));
            }
        }
    }
}
