use motion::{Channel, Episode, Subject, Verdict};
use nalgebra::DVector;

use crate::notes::Notes;
use crate::numbers::{percent, short};
use crate::options::{PrepareOptions, VelocityUse};
use crate::repairs::displacements::{Part, displacements};
use crate::repairs::stamps::{SLOW, UNITS, usual_step};
use crate::repairs::velocity_origin::VelocityOrigin;
use crate::repairs::{lag, velocity_offset};
use crate::samples::noise::Noise;

/// Velocities agree with the steps if they differ by at most this factor.
const AGREE: f64 = 1.25;
/// Velocities are unrelated to the steps if they explain less than this share of the steps' squares.
const UNRELATED: f64 = 0.5;
/// Without a constant offset, velocities must leave at most this share of what they do not explain of the steps.
const OFFSET: f64 = 0.5;
/// A factor is attributed to a common mistake if it is within this tolerance.
const NEAR: f64 = 0.1;
/// Maximum residual of the velocities, in multiples of the noise.
const NOISE: f64 = 1.5;
/// A channel hardly moves if its squared steps are below this share of all.
const STILL: f64 = 1e-6;
/// The velocities of a channel that hardly moves may be noise up to this share of all squared steps by velocities.
const NOISE_OF_STILL: f64 = 0.04;
/// Number of parts of a movement that are compared.
const PARTS: usize = 4;
/// Velocities were computed from positions if they differ from differences of these by at most this share.
const SAME: f64 = 1e-6;

/// Compares velocities with the steps; converts them to the steps' units, or drops them.
pub(crate) fn decide(
    episodes: &mut [Episode],
    options: &PrepareOptions,
    channels: &[Channel],
    noise: &Noise,
    notes: &mut Notes,
) -> VelocityOrigin {
    let recorded = episodes.iter().filter(|episode| episode.velocities.is_some()).count();
    if recorded < episodes.len() || options.velocities == VelocityUse::Ignored {
        discard(episodes);
        let why = match recorded {
            0 => "none recorded".to_owned(),
            _ if recorded < episodes.len() => format!("only {recorded} of {} episodes have them", episodes.len()),
            _ => "ignored as requested".to_owned(),
        };
        if options.velocities == VelocityUse::Recorded {
            let but = if recorded == 0 { "there are none" } else { &why };
            let what = format!("recorded velocities were requested, but {but}: they are taken from the positions");
            notes.found(
                Verdict::Doubtful,
                what,
                "record velocities in every episode, or leave out the episodes without",
            );
        }
        notes.decided(Subject::Velocities, "from positions", why);
        return VelocityOrigin::Missing;
    }
    if options.velocities == VelocityUse::Recorded {
        notes.decided(Subject::Velocities, "recorded", "used as requested");
        return VelocityOrigin::Measured;
    }
    if lag::repair(episodes, noise, notes) {
        discard(episodes);
        return VelocityOrigin::Missing;
    }
    let mut fit = Steps::of(episodes, noise);
    if let Some((offset, without)) = without_offset(episodes, &fit, noise) {
        velocity_offset::report(&offset, channels, notes);
        fit = without;
    }
    if fit.explained < UNRELATED {
        discard(episodes);
        let explained = percent(fit.explained.max(0.0));
        let why = format!("those recorded explain {explained} of the steps");
        notes.decided(Subject::Velocities, "from positions", why);
        notes.found(
            Verdict::Doubtful,
            format!("recorded velocities do not match the steps (they explain {explained} of them) and were ignored"),
            "check that these columns are velocities of the same channels in the same order",
        );
        return VelocityOrigin::Missing;
    }
    if fit.agree(1.0) {
        let made = made_of_positions(episodes);
        let (value, why) = match made {
            Some(VelocityOrigin::Differences) => ("from positions", "those recorded are differences of them"),
            Some(_) => ("recorded", "recorded; they are differences of the positions"),
            None => ("recorded", "recorded; they agree with the steps"),
        };
        notes.decided(Subject::Velocities, value, why);
        return made.unwrap_or(VelocityOrigin::Measured);
    }
    let stamps_are_given = options.time_step.is_some() || options.time_unit_given;
    if stamps_are_given || !in_seconds(episodes, &fit, notes) {
        rescale(episodes, &fit, channels, notes);
    }
    VelocityOrigin::Measured
}

/// Subtracts a constant from the velocities if they then agree with the steps much better than in any unit; returns it and the new fit.
fn without_offset(episodes: &mut [Episode], fit: &Steps, noise: &Noise) -> Option<(DVector<f64>, Steps)> {
    let offset = velocity_offset::of(episodes)?;
    let recorded: Vec<_> = episodes.iter().map(|episode| episode.velocities.clone()).collect();
    velocity_offset::subtract(episodes, &offset);
    let without = Steps::of(episodes, noise);
    if without.agree(1.0) && 1.0 - without.explained < OFFSET * (1.0 - fit.explained) {
        return Some((offset, without));
    }
    for (episode, recorded) in episodes.iter_mut().zip(recorded) {
        episode.velocities = recorded;
    }
    None
}

/// Leaves the positions alone.
fn discard(episodes: &mut [Episode]) {
    for episode in episodes {
        episode.velocities = None;
    }
}

/// Factors between steps and steps computed from velocities, over parts of movements: Σ D S / Σ S² in each channel, S = Σ
/// u δt.
struct Steps {
    /// (n).
    factors: DVector<f64>,
    /// 1 − Σ |D − factor S|² / Σ |D|².
    explained: f64,
}

impl Steps {
    /// Whether velocities agree with the steps if time is divided by `times`.
    fn agree(&self, times: f64) -> bool {
        self.factors.iter().all(|factor| (1.0 / AGREE..AGREE).contains(&(factor * times)))
    }

    fn of(episodes: &[Episode], noise: &Noise) -> Self {
        let pairs: Vec<Part> = episodes.iter().flat_map(parts).collect();
        let dim = episodes[0].positions.nrows();
        let sum = |of: &dyn Fn(&Part) -> f64| pairs.iter().map(of).sum::<f64>();
        let power = sum(&|(_, s)| s.norm_squared());
        let common = sum(&|(d, s)| d.dot(s)) / power;
        let moved = sum(&|(d, _)| d.norm_squared());
        let variance = |axis: usize| noise.positions.as_ref().map_or(0.0, |sd| sd[axis] * sd[axis]);
        let factor = |axis: usize| {
            let (own, own_moved) = (sum(&|(_, s)| s[axis].powi(2)), sum(&|(d, _)| d[axis].powi(2)));
            let still = own_moved <= STILL * moved + NOISE * 2.0 * variance(axis) * pairs.len() as f64;
            match own / power {
                // A channel that hardly moves does not determine a factor, because its velocities may be noise.
                share if share <= STILL || still && share <= NOISE_OF_STILL => common,
                _ if still => 0.0,
                _ => sum(&|(d, s)| d[axis] * s[axis]) / own,
            }
        };
        let factors = DVector::from_fn(dim, |axis, _| factor(axis));
        let left = sum(&|(d, s)| (d - s.component_mul(&factors)).norm_squared());
        // Both ends of a part contain the positions' noise.
        let noise = 2.0 * (0..dim).map(variance).sum::<f64>() * pairs.len() as f64;
        let explained = if left <= NOISE * noise { 1.0 } else { 1.0 - (left - noise) / (moved - noise) };
        Steps { factors, explained: if explained.is_finite() { explained } else { 0.0 } }
    }
}

/// Displacements of parts of a movement, and those computed from velocities.
fn parts(episode: &Episode) -> Vec<Part> {
    let steps = episode.n_samples() - 1;
    let parts = PARTS.min((steps / 2).max(1));
    let Some(velocities) = &episode.velocities else { return Vec::new() };
    (0..parts)
        .map(|part| displacements(episode, velocities, part * steps / parts..(part + 1) * steps / parts))
        .collect()
}

/// The kind of velocities that were computed from positions: each the step after it, or the step before it or the mean of
/// both.
fn made_of_positions(episodes: &[Episode]) -> Option<VelocityOrigin> {
    let off = |of: &dyn Fn(&Episode, usize) -> DVector<f64>| {
        let (mut left, mut power) = (0.0, 0.0);
        for episode in episodes {
            let Some(velocities) = &episode.velocities else { continue };
            for i in 1..episode.n_samples() - 1 {
                left += (velocities.column(i) - of(episode, i)).norm_squared();
                power += velocities.column(i).norm_squared();
            }
        }
        left <= SAME * SAME * power
    };
    let after = |episode: &Episode, i: usize| episode.step(i) / episode.times.seconds(i, i + 1);
    let before = |episode: &Episode, i: usize| episode.step(i - 1) / episode.times.seconds(i - 1, i);
    let both = |episode: &Episode, i: usize| {
        (episode.step(i) + episode.step(i - 1)) / (episode.times.seconds(i, i + 1) + episode.times.seconds(i - 1, i))
    };
    if off(&after) {
        return Some(VelocityOrigin::Steps);
    }
    (off(&before) || off(&both)).then_some(VelocityOrigin::Differences)
}

/// Converts stamps of milliseconds or microseconds to seconds, reports it and returns true, if that makes all velocities agree with
/// the steps.
fn in_seconds(episodes: &mut [Episode], fit: &Steps, notes: &mut Notes) -> bool {
    let step = usual_step(episodes).unwrap_or(1.0);
    let Some(unit) = UNITS.into_iter().find(|unit| step > SLOW && fit.agree(unit.per_second())) else { return false };
    for episode in episodes.iter_mut() {
        episode.times = episode.times.divided_by(unit.per_second());
    }
    let what = format!("stamps are {step:.0} apart and velocities {} times the steps", unit.per_second());
    // Keeps only the valid one of two decisions on the time step.
    notes.decisions.retain(|decision| decision.what != Subject::TimeStep);
    let seconds = format!("{} s", step / unit.per_second());
    notes.decided(Subject::TimeStep, seconds, format!("{what}: stamps are {}", unit.name()));
    let next = format!("--time-unit {}, or --dt", unit.symbol());
    notes.found(Verdict::Doubtful, format!("{what}: stamps were read as {}", unit.name()), next);
    true
}

/// Converts velocities in other units than the steps to those of positions and stamps, and reports it.
fn rescale(episodes: &mut [Episode], fit: &Steps, channels: &[Channel], notes: &mut Notes) {
    let (low, high) = (fit.factors.min(), fit.factors.max());
    let step = usual_step(episodes).unwrap_or(1.0);
    let common = low * high > 0.0 && high / low < AGREE && low / high < AGREE;
    let factors = if common {
        let factor = (low * high).sqrt().copysign(low);
        DVector::repeat(channels.len(), 1.0 / mistake(1.0 / factor, step).map_or(1.0 / factor, |(times, _)| times))
    } else {
        fit.factors.clone()
    };
    for velocities in episodes.iter_mut().filter_map(|episode| episode.velocities.as_mut()) {
        velocities.column_iter_mut().for_each(|mut column| column.component_mul_assign(&factors));
    }
    let (what, times) = if common {
        let times = 1.0 / factors[0];
        (format!("velocities are {} times the steps", short(times)), times)
    } else {
        let odd = (0..channels.len()).max_by(|&a, &b| off(fit.factors[a]).total_cmp(&off(fit.factors[b]))).unwrap_or(0);
        let (name, factor) = (&channels[odd].name, fit.factors[odd]);
        if factor == 0.0 {
            let what = format!("velocities of channel {name} are not 0, although it never moves");
            notes.decided(Subject::Velocities, "recorded, 0 where a channel never moves", what.clone());
            let next = "check that the column of velocities belongs to this channel (--velocity)";
            notes.found(Verdict::Doubtful, format!("{what}; they were set to 0"), next);
            return;
        }
        let times = 1.0 / factor;
        (format!("velocities of channel {name} are {} times its steps, unlike the others", short(times)), times)
    };
    let next = mistake(times, step).map_or("check units and time step (--dt), or whether a filter delays them: --integration displacement takes velocities from the positions", |(_, words)| words);
    notes.decided(Subject::Velocities, "recorded, rescaled to agree with the steps", what.clone());
    notes.found(Verdict::Doubtful, format!("{what}; they were converted to the units of positions and stamps"), next);
}

/// Deviation of a factor from 1, in either direction; a change of sign deviates most.
fn off(factor: f64) -> f64 {
    if factor < 0.0 { f64::INFINITY } else { factor.ln().abs() }
}

/// The factor of the common mistake that is nearest to `times`, with some per cent of tolerance for integration rules, and the
/// advice.
fn mistake(times: f64, step: f64) -> Option<(f64, &'static str)> {
    let degrees = "degrees and radians mixed? Use one of them (--degrees)";
    let mistakes = [
        (
            1000.0,
            "velocity columns in millimetres, or stamps in milliseconds? Name the units in the file, or give --time-unit ms",
        ),
        (0.001, "positions in millimetres? Name the units in the file"),
        (60.0, "velocities per minute? Convert them to seconds"),
        (1.0 / 60.0, "stamps in minutes? Convert them to seconds"),
        (1f64.to_degrees(), degrees),
        (1f64.to_radians(), degrees),
        (-1.0, "check the sign: velocities point against the movement"),
        (step, "these are steps, not velocities per second"),
    ];
    let off = |factor: f64| (times / factor - 1.0).abs();
    mistakes.into_iter().filter(|(factor, _)| off(*factor) < NEAR).min_by(|a, b| off(a.0).total_cmp(&off(b.0)))
}
