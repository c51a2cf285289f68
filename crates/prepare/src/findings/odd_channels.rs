//! Detects channels that are no coordinates of the movement: switches, and copies of others.

use motion::{Channel, Episode, Finding};

use crate::numbers::short;

/// Maximum difference of a copy, as a share of the largest value, because digits may be cut off.
const ALIKE: f64 = 1e-6;
/// Above this number, channels are not compared.
const MOST: usize = 256;

/// Whether a channel has only two values, and changes between them within a movement.
pub(crate) fn is_switch(episodes: &[Episode], axis: usize) -> bool {
    values(episodes, axis).is_some()
}

/// The two values of a switch.
fn values(episodes: &[Episode], axis: usize) -> Option<[f64; 2]> {
    let all = || episodes.iter().map(|episode| episode.positions.row(axis));
    let first = all().find_map(|row| row.iter().next().copied())?;
    let other = all().find_map(|row| row.iter().copied().find(|&value| value != first))?;
    let only = all().all(|row| row.iter().all(|&value| value == first || value == other));
    let changes = all().any(|row| row.iter().any(|&value| value != row[0]));
    // Three samples may have two values by chance.
    let count: usize = all().map(|row| row.len()).sum();
    (only && changes && count > 8).then(|| [first.min(other), first.max(other)])
}

/// Reports channels that are switches, and channels that are copies of others. A switch jumps, so that no movement leads from one of its
/// values to the other. A copy shows no additional motion.
pub(crate) fn odd_channels(episodes: &[Episode], channels: &[Channel]) -> Vec<Finding> {
    let n = channels.len();
    if !(2..=MOST).contains(&n) {
        return Vec::new();
    }
    let name = |axis: usize| &channels[axis].name;
    let of_switch = |axis: usize| {
        let [low, high] = values(episodes, axis)?.map(short);
        Some(Finding::doubt(
            format!("{} has two values only, {low} and {high}, as a switch has", name(axis)),
            format!("--ignore {}, if it is a gripper or the like: no coordinate of the movement", name(axis)),
        ))
    };
    let is_copy = |first: usize, second: usize| {
        let rows = || episodes.iter().map(|of| (of.positions.row(first), of.positions.row(second)));
        let largest = rows().map(|(row, _)| row.amax()).fold(0.0, f64::max);
        let varies = rows().any(|(row, _)| row.iter().any(|&value| value != row[0]));
        varies && rows().all(|(a, b)| a.iter().zip(b.iter()).all(|(a, b)| (a - b).abs() <= ALIKE * largest))
    };
    let of_copy = |second: usize| {
        let first = (0..second).find(|&first| is_copy(first, second))?;
        Some(Finding::doubt(
            format!("{} has the values of {} everywhere: a copy, it seems", name(second), name(first)),
            format!("--ignore {}, unless a constraint common to all movements keeps them equal", name(second)),
        ))
    };
    (0..n).filter_map(of_switch).chain((0..n).filter_map(of_copy)).collect()
}

#[cfg(test)]
mod tests {
    use motion::{Source, Times};
    use nalgebra::{DMatrix, DVector};

    use super::*;

    /// Four movements with the channels x, y, z, given by `value(channel, movement, sample)`.
    fn found(value: impl Fn(usize, usize, usize) -> f64) -> Vec<(String, String)> {
        let one = |k: usize| Episode {
            name: k.to_string(),
            source: Source::default(),
            times: Times::Even { step: 0.1, len: 30 },
            positions: DMatrix::from_fn(3, 30, |axis, i| value(axis, k, i)),
            velocities: None,
            constraint: None,
            context: DVector::zeros(0),
        };
        let episodes: Vec<Episode> = (0..4).map(one).collect();
        let channels = ["x", "y", "z"].map(|name| Channel { name: name.to_owned(), unit: None });
        let found = odd_channels(&episodes, &channels);
        found.into_iter().map(|finding| (finding.what, finding.next)).collect()
    }

    fn place(axis: usize, k: usize, i: usize) -> f64 {
        (k as f64 + 1.7 * axis as f64).sin() * (-0.1 * i as f64).exp()
    }

    #[test]
    fn switches_and_copies_are_named_and_no_others() {
        assert_eq!(found(place), []);
        let switch = found(|axis, k, i| if axis == 1 { f64::from(u8::from(i > 10 + k)) } else { place(axis, k, i) });
        assert_eq!(switch.len(), 1);
        assert_eq!(switch[0].0, "y has two values only, 0 and 1, as a switch has");
        assert!(switch[0].1.starts_with("--ignore y"));
        let copy = found(|axis, k, i| place(axis % 2, k, i) + if axis == 2 { 1e-9 } else { 0.0 });
        assert_eq!(copy.len(), 1);
        assert!(copy[0].0.starts_with("z has the values of x") && copy[0].1.starts_with("--ignore z,"), "{copy:?}");
        // A channel that is constant within movements may be a context, and channels that never move are no copies.
        assert_eq!(found(|axis, k, i| if axis == 1 { (k % 2) as f64 } else { place(axis, k, i) }), []);
        assert_eq!(found(|axis, k, i| if axis == 0 { place(axis, k, i) } else { 0.0 }), []);
    }
}
