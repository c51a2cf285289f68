use std::f64::consts::TAU;

use demo_io::Channel;

use crate::Verdict;
use crate::episodes::Take;
use crate::prepared::Notes;

/// A step over this share of a turn is a wrap.
const WRAP: f64 = 0.75;
/// Angles that wrap come this near to the end of their range, and hardly beyond.
const RANGE: std::ops::RangeInclusive<f64> = 0.9..=1.02;

/// Angles that jump by a whole turn go on instead; every movement ends within half a turn of where all end.
pub(crate) fn unwrap(takes: &mut [Take], channels: &[Channel], notes: &mut Notes) {
    for (channel, described) in channels.iter().enumerate() {
        let Some(turn) = turn(takes, channel) else { continue };
        let wrapped = takes.iter().filter(|take| has_wraps(take, channel, turn)).count();
        if wrapped == 0 {
            continue;
        }
        for take in takes.iter_mut() {
            go_on(take, channel, turn);
        }
        to_common_end(takes, channel, turn);
        let name = &described.name;
        notes.decided(
            "angles",
            format!("{name} unwrapped"),
            format!("it jumps by a whole turn in {wrapped} episodes"),
            "--wraps",
        );
        notes.found(
            Verdict::Doubtful,
            format!("channel {name} wraps by a whole turn in {wrapped} of {} episodes; it was unwrapped", takes.len()),
            "check that all episodes now end at the same place, or record angles that do not wrap",
        );
    }
}

/// A whole turn in the units of a channel whose values fill one, in radians or degrees.
fn turn(takes: &[Take], channel: usize) -> Option<f64> {
    let values = || takes.iter().flat_map(|take| take.positions.row(channel).iter().copied().collect::<Vec<_>>());
    let (low, high) = values().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    let fills = |turn: f64| {
        let symmetric = RANGE.contains(&(high / (turn / 2.0))) && RANGE.contains(&(-low / (turn / 2.0)));
        let positive = RANGE.contains(&(high / turn)) && low.abs() < 0.1 * turn;
        symmetric || positive
    };
    [TAU, 360.0].into_iter().find(|&turn| fills(turn))
}

fn has_wraps(take: &Take, channel: usize, turn: f64) -> bool {
    (1..take.n_samples()).any(|i| (take.positions[(channel, i)] - take.positions[(channel, i - 1)]).abs() > WRAP * turn)
}

fn go_on(take: &mut Take, channel: usize, turn: f64) {
    let mut turns = 0.0;
    let mut before = take.positions[(channel, 0)];
    for i in 1..take.n_samples() {
        let now = take.positions[(channel, i)];
        if (now - before).abs() > WRAP * turn {
            turns -= ((now - before) / turn).round();
            if let Some(velocities) = &mut take.velocities {
                // Velocities that were made of the positions jump with them.
                let seconds = take.times[i] - take.times[i - 1];
                for sample in [i - 1, i] {
                    let velocity = &mut velocities[(channel, sample)];
                    if (*velocity * seconds).abs() > WRAP * turn {
                        *velocity -= turn / seconds * (*velocity * seconds / turn).round();
                    }
                }
            }
        }
        before = now;
        take.positions[(channel, i)] += turns * turn;
    }
}

fn to_common_end(takes: &mut [Take], channel: usize, turn: f64) {
    let end = |take: &Take| take.positions[(channel, take.n_samples() - 1)];
    let (sine, cosine) = takes.iter().fold((0.0, 0.0), |(sine, cosine), take| {
        let angle = end(take) / turn * TAU;
        (sine + angle.sin(), cosine + angle.cos())
    });
    let common = f64::atan2(sine, cosine) / TAU * turn;
    for take in takes {
        let turns = ((end(take) - common) / turn).round();
        take.positions.row_mut(channel).add_scalar_mut(-turns * turn);
    }
}
