//! Findings before learning.

mod end_places;
mod held_channels;
mod integrals;
mod odd_channels;
mod other_units;
mod pressing;
mod speed_limit;
mod velocities_and_clocks;

pub use end_places::end_places;
pub(crate) use held_channels::held_channels;
use motion::{Demonstrations, Finding, Topic, Trajectory, Verdict, standard_deviation};
pub(crate) use odd_channels::{is_switch, odd_channels};
pub(crate) use other_units::other_units;
use pressing::pressing;
use speed_limit::speed_limit;
pub(crate) use velocities_and_clocks::velocities_and_clocks;

use crate::StateChannel;
use crate::notes::Notes;
use crate::numbers::{counted, percent, short};
use crate::samples::noise::{Noise, resolution};

/// A channel with this multiple of the spread of most others seems to have another unit.
const MIXED: f64 = 20.0;
/// Fewer episodes reveal too little about constraints, and about the regions between them.
const FEW: usize = 8;
/// An episode is a loop if the distance of its ends is at most this share of its length.
const LOOP: f64 = 0.05;
/// Positions have few digits if a step of the last digit is this share of a channel's spread.
const COARSE: f64 = 0.01;

/// Adds the findings on movements as a whole.
pub(crate) fn examine(demonstrations: &Demonstrations, state: &[StateChannel], noise: &Noise, notes: &mut Notes) {
    notes.findings.extend(depending_on_scale(demonstrations, state, noise));
    few_movements(demonstrations, notes);
    loops(demonstrations, notes);
    coarse(demonstrations, &spreads(demonstrations), state, notes);
}

/// Findings that depend on the scale of each channel.
pub(crate) fn depending_on_scale(
    demonstrations: &Demonstrations,
    state: &[StateChannel],
    noise: &Noise,
) -> Vec<Finding> {
    let mixed = mixed_units(&spreads(demonstrations), state).map(|finding| finding.on(Topic::MixedUnits));
    let press = pressing(demonstrations, state).map(|finding| finding.on(Topic::Pressing));
    let limit = speed_limit(demonstrations, state, noise).map(|finding| finding.on(Topic::SpeedLimit));
    [mixed, press, limit].into_iter().flatten().collect()
}

/// Standard deviation of each channel, (n).
fn spreads(demonstrations: &Demonstrations) -> Vec<f64> {
    (0..demonstrations.dim()).map(|axis| standard_deviation(demonstrations.values(axis))).collect()
}

/// Reports a channel whose spread suggests another unit than that of the others.
fn mixed_units(spreads: &[f64], state: &[StateChannel]) -> Option<Finding> {
    let mut sorted: Vec<f64> = spreads.iter().copied().filter(|&spread| spread > 0.0).collect();
    sorted.sort_by(f64::total_cmp);
    let (&largest, others) = sorted.split_last()?;
    let times = largest / others.get(others.len() / 2)?;
    // The channels nearer to the largest spread than to that of most others.
    let wide = spreads.iter().zip(state).filter(|(spread, _)| **spread * times.sqrt() >= largest);
    let names: Vec<&str> = wide.map(|(_, channel)| channel.name.as_str()).collect();
    let vary = match &names[..] {
        [name] => format!("channel {name} varies {times:.0} times"),
        names => format!("channels {} vary up to {times:.0} times", names.join(", ")),
    };
    let scales: Vec<String> = names.iter().map(|name| format!("{name}=0.001")).collect();
    let (degrees, scales) = (names.join(","), scales.join(","));
    (times >= MIXED).then(|| Finding::doubt(
        format!("{vary} as much as the others: different unit (degrees, millimetres)?"),
        format!(
            "all channels need one unit, because constraints act at right angles: --degrees {degrees} converts degrees to radians, --scale {scales} millimetres to metres"
        ),
    ))
}

fn few_movements(demonstrations: &Demonstrations, notes: &mut Notes) {
    let count = demonstrations.n_trajectories();
    if count < FEW {
        let verb = if count == 1 { "is" } else { "are" };
        notes.found(
            Verdict::Doubtful,
            format!("{} {verb} too few to infer what constraints hid", counted(count, "movement")),
            "record at least 10, from different starts and under different constraints",
        );
    }
}

fn loops(demonstrations: &Demonstrations, notes: &mut Notes) {
    let is_loop = |movement: &&Trajectory| {
        let last = movement.n_samples() - 1;
        let length: f64 = (0..last).map(|i| (movement.state(i + 1) - movement.state(i)).norm()).sum();
        let furthest = (0..=last).map(|i| (movement.state(i) - movement.state(0)).norm()).fold(0.0, f64::max);
        let back = (movement.state(last) - movement.state(0)).norm();
        back < LOOP * length && furthest > 0.2 * length && last > 10
    };
    let loops = demonstrations.trajectories().iter().filter(is_loop).count();
    if loops > 0 {
        notes.found(
            Verdict::Good,
            format!("{loops} of {} episodes return to their start", demonstrations.n_trajectories()),
            "a potential cannot explain a round trip: split them for --learner policy-align; other learners allow rotation",
        );
    }
}

fn coarse(demonstrations: &Demonstrations, spreads: &[f64], state: &[StateChannel], notes: &mut Notes) {
    for (axis, channel) in state.iter().enumerate() {
        let Some(least) = resolution(demonstrations, axis) else { continue };
        if least > COARSE * spreads[axis] {
            notes.found(
                Verdict::Good,
                format!(
                    "channel {} has a resolution of {}, {} of its spread: positions have few digits",
                    channel.name,
                    short(least),
                    percent(least / spreads[axis])
                ),
                "save more digits, or record velocities",
            );
        }
    }
}
