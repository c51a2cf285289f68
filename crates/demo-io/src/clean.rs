//! Turns a reader's result into valid samples: finite, ordered by time, without duplicates.

mod finite;

use self::finite::make_finite;
use crate::names::selection::flags;
use crate::raw::{RawEpisode, RawRecordings, positive, remark, unused};
use crate::rows::roles;
use crate::{Fault, Nan, ReadError, ReadOptions};
use motion::{Channel, Finding, is_called_context, is_in_degrees, unwrap_angle};

/// LeRobot's name for the positions of objects.
pub(crate) const ENVIRONMENT: &str = "observation.environment_state";

/// A clock that goes back to this share of the elapsed time or less has restarted.
const BEGINNING: f64 = 0.1;

/// Checks and repairs every episode according to the options. `channels` are those of other recordings of the set.
pub(crate) fn clean(
    recordings: &mut RawRecordings,
    channels: &[String],
    options: &ReadOptions,
) -> Result<(), ReadError> {
    positive(options.split_gap, "--split-gap")?;
    if recordings.drop_constant {
        leave_out_constant(recordings, channels);
    }
    if options.context.is_empty() {
        leave_out_moving_environment(recordings, channels);
        refuse_moving_context(recordings)?;
    }
    name_units(recordings, options)?;
    degrees_to_radians(recordings, options)?;
    let names = recordings.names();
    let mut episodes = Vec::with_capacity(recordings.episodes.len());
    let (mut missing, mut samples) = (0, 0);
    for mut raw in recordings.episodes.drain(..) {
        samples += raw.len();
        missing += make_finite(&mut raw, &names, recordings.word, options.nan)?;
        if options.sort {
            sort(&mut raw);
        }
        if let Some(longest) = options.split_gap {
            episodes.extend(split(raw, longest));
        } else {
            refuse_backwards(&raw, recordings.word)?;
            episodes.push(raw);
        }
    }
    recordings.findings.extend(not_recorded(missing, samples, options.nan));
    for raw in &mut episodes {
        from_zero(raw);
        recordings.findings.extend(leave_out_duplicates(raw, recordings.word));
    }
    recordings.episodes = episodes;
    unwrap_angles(recordings, options)?;
    Ok(())
}

/// Drops unnamed columns that never change, such as a stopped counter or a sensor that is off; they are no state. `known` are the
/// channels of other recordings.
fn leave_out_constant(recordings: &mut RawRecordings, known: &[String]) {
    let n = recordings.channels.len();
    let mut first: Vec<f64> = vec![f64::NAN; n];
    let mut changes: Vec<bool> = recordings.channels.iter().map(|channel| known.contains(&channel.name)).collect();
    for raw in &recordings.episodes {
        for sample in raw.positions.chunks_exact(n) {
            for ((first, changes), &value) in first.iter_mut().zip(&mut changes).zip(sample) {
                if first.is_nan() {
                    *first = value;
                }
                *changes |= value != *first && !value.is_nan();
            }
        }
    }
    let recorded = recordings.episodes.iter().any(|raw| !raw.velocities.is_empty());
    if recorded || changes.iter().all(|&changes| changes) || !changes.contains(&true) {
        return;
    }
    let constant = recordings.channels.iter().zip(&changes).filter(|(_, changes)| !**changes);
    let names: Vec<&str> = constant.map(|(channel, _)| &channel.name[..]).collect();
    let what = format!("constant columns are not taken as state: {}", roles::shortened(&names));
    recordings.findings.push(remark(what, "--state with their names takes them"));
    retain_channels(recordings, &changes);
}

/// Drops the channels that do not stay, with their numbers.
fn retain_channels(recordings: &mut RawRecordings, stays: &[bool]) {
    let mut column = stays.iter();
    recordings.channels.retain(|_| *column.next().unwrap_or(&true));
    for numbers in recordings.episodes.iter_mut().flat_map(|raw| [&mut raw.positions, &mut raw.velocities]) {
        let mut column = stays.iter().cycle();
        numbers.retain(|_| *column.next().unwrap_or(&true));
    }
}

/// A finding on samples that were not finite.
fn not_recorded(missing: usize, samples: usize, nan: Nan) -> Option<Finding> {
    let what = match nan {
        Nan::Drop => "were left out",
        Nan::Refuse | Nan::Fill => "were interpolated",
    };
    let what = format!("{missing} of {samples} samples were not finite and {what}");
    (missing > 0).then(|| remark(what, "check the recorder: what is missing is often missing where it matters"))
}

/// LeRobot's environment is context if it is constant within every episode and differs between episodes; otherwise it is not used. If
/// `channels` have been read before, they decide.
fn leave_out_moving_environment(recordings: &mut RawRecordings, channels: &[String]) {
    let n = recordings.channels.len();
    let is_environment = |channel: &Channel| channel.name.starts_with(ENVIRONMENT);
    let stays: Vec<bool> = recordings.channels.iter().map(|channel| !is_environment(channel)).collect();
    if stays.iter().all(|&stays| stays) {
        return;
    }
    let part = |sample: &[f64]| -> Vec<f64> {
        sample.iter().zip(&stays).filter(|(_, stays)| !**stays).map(|(value, _)| *value).collect()
    };
    let mut firsts = recordings.episodes.iter().filter_map(|raw| raw.positions.chunks_exact(n).next()).map(part);
    let first = firsts.next();
    let differs = firsts.any(|other| Some(&other) != first.as_ref());
    let moves = |raw: &RawEpisode| {
        let mut samples = raw.positions.chunks_exact(n).map(part);
        let first = samples.next();
        samples.any(|sample| Some(&sample) != first.as_ref())
    };
    let is_context = if channels.is_empty() {
        differs && !recordings.episodes.iter().any(moves)
    } else {
        channels.iter().any(|name| name.starts_with(ENVIRONMENT))
    };
    if is_context {
        return;
    }
    let names: Vec<&str> =
        recordings.channels.iter().filter(|channel| is_environment(channel)).map(|channel| &channel.name[..]).collect();
    recordings.findings.extend(unused("columns", &names, &[]));
    retain_channels(recordings, &stays);
}

/// Refuses a channel that is named like a context and changes within an episode, if velocities are recorded and its are all 0.
fn refuse_moving_context(recordings: &RawRecordings) -> Result<(), ReadError> {
    let n = recordings.channels.len();
    let values_of =
        |numbers: &[f64], channel: usize| numbers.iter().skip(channel).step_by(n).copied().collect::<Vec<_>>();
    for (channel, described) in recordings.channels.iter().enumerate().filter(|(_, of)| is_called_context(&of.name)) {
        let without = |raw: &RawEpisode| {
            !raw.velocities.is_empty() && values_of(&raw.velocities, channel).iter().all(|&velocity| velocity == 0.0)
        };
        let moves = |raw: &&RawEpisode| values_of(&raw.positions, channel).windows(2).any(|pair| pair[0] != pair[1]);
        let Some(moving) = recordings.episodes.iter().find(moves) else { continue };
        if recordings.episodes.iter().all(without) {
            let what = format!("'{}' changes within an episode and has no velocity", described.name);
            let remedy =
                format!("--ignore '{}', or --state and --velocity with the columns of the state", described.name);
            return Err(ReadError::NoRoles(Fault::new(what, moving.place(0, recordings.word), remedy)));
        }
    }
    Ok(())
}

/// Applies `--units m`, `--units x=mm`.
fn name_units(recordings: &mut RawRecordings, options: &ReadOptions) -> Result<(), ReadError> {
    let names = recordings.names();
    for assignment in options.units.iter().flat_map(|text| text.split(',')) {
        let (pattern, unit) = assignment.split_once('=').unwrap_or(("*", assignment));
        for channel in named(&[pattern.trim().to_owned()], &names, "--units")? {
            recordings.channels[channel].unit = Some(unit.trim().to_owned());
        }
    }
    Ok(())
}

/// The channels that match a flag's patterns.
fn named(patterns: &[String], names: &[String], flag: &str) -> Result<Vec<usize>, ReadError> {
    roles::named(patterns, names, &format!("{flag}, among the channels of the state"))
}

fn degrees_to_radians(recordings: &mut RawRecordings, options: &ReadOptions) -> Result<(), ReadError> {
    let names = recordings.names();
    for channel in named(&options.degrees, &names, "--degrees")? {
        recordings.channels[channel].unit = Some("rad".to_owned());
        for raw in &mut recordings.episodes {
            for numbers in [&mut raw.positions, &mut raw.velocities] {
                for value in numbers.iter_mut().skip(channel).step_by(names.len()) {
                    *value = value.to_radians();
                }
            }
        }
    }
    Ok(())
}

/// Sorts samples by stamp, stably.
fn sort(raw: &mut RawEpisode) {
    let mut order: Vec<usize> = (0..raw.len()).collect();
    order.sort_by(|&a, &b| raw.times[a].total_cmp(&raw.times[b]));
    *raw = raw.chosen(order.iter().copied());
}

fn refuse_backwards(raw: &RawEpisode, word: &str) -> Result<(), ReadError> {
    let Some(at) = raw.times.windows(2).position(|pair| pair[1] < pair[0]) else { return Ok(()) };
    let what = format!("stamps go back by {} s", rounded(raw.times[at] - raw.times[at + 1]));
    let cut = "--split-gap 1 if a new movement begins here (cuts where stamps go back or pause for 1 s)";
    let sort = "--sort (puts samples in the order of their stamps)";
    let begins_again = raw.times[at + 1] - raw.times[0] <= BEGINNING * (raw.times[at] - raw.times[0]);
    let (first, second) = if begins_again { (cut, sort) } else { (sort, cut) };
    let remedy = format!("{first}, or {second}");
    Err(ReadError::TimeBackwards(Fault::new(what, raw.place(at + 1, word), remedy)))
}

/// Shifts times to seconds from the first sample. Stamps that this rounds to the same value become equal.
fn from_zero(raw: &mut RawEpisode) {
    let first = raw.times.first().copied().unwrap_or(0.0);
    raw.times.iter_mut().for_each(|time| *time -= first);
}

/// Keeps the first of samples with equal stamps.
fn leave_out_duplicates(raw: &mut RawEpisode, word: &str) -> Option<Finding> {
    let duplicate = |sample: &usize| *sample > 0 && raw.times[*sample] == raw.times[sample - 1];
    let first = (0..raw.len()).find(duplicate)?;
    let retained: Vec<usize> = (0..raw.len()).filter(|sample| !duplicate(sample)).collect();
    let more = match raw.len() - retained.len() {
        1 => String::new(),
        duplicates => format!(" (and {} more)", duplicates - 1),
    };
    let what = format!("{}: a stamp occurs twice; kept the first of its samples{more}", raw.place(first, word));
    *raw = raw.chosen(retained.iter().copied());
    Some(remark(what, "check the recorder's clock"))
}

/// Cuts an episode where stamps go back, or are more than `longest` seconds apart.
fn split(raw: RawEpisode, longest: f64) -> Vec<RawEpisode> {
    let mut cuts: Vec<usize> = vec![0];
    let passed = |sample: usize| raw.times[sample] - raw.times[sample - 1];
    cuts.extend((1..raw.len()).filter(|&sample| passed(sample) < 0.0 || passed(sample) > longest));
    cuts.push(raw.len());
    if cuts.len() == 2 {
        return vec![raw];
    }
    let part = |(number, cut): (usize, &[usize])| {
        let name = format!("{}_{number}", raw.name);
        RawEpisode { name, ..raw.chosen(cut[0]..cut[1]) }
    };
    cuts.windows(2).enumerate().map(part).collect()
}

/// Makes the named angles continuous.
fn unwrap_angles(recordings: &mut RawRecordings, options: &ReadOptions) -> Result<(), ReadError> {
    let names = recordings.names();
    if options.unwrap.iter().any(|pattern| pattern != "*") {
        named(&options.unwrap, &names, "--unwrap")?;
    }
    for (channel, _) in flags(&options.unwrap, &names).iter().enumerate().filter(|(_, chosen)| **chosen) {
        let turn = whole_turn(recordings, channel);
        for RawEpisode { positions, velocities, times, .. } in &mut recordings.episodes {
            let seconds = |sample: usize| times[sample] - times[sample - 1];
            unwrap_angle(positions, velocities, (names.len(), channel), turn, seconds);
        }
    }
    Ok(())
}

/// A whole turn in a channel's unit. Without a unit it is radians, unless its values cover more than two turns.
fn whole_turn(recordings: &RawRecordings, channel: usize) -> f64 {
    let turn = std::f64::consts::TAU;
    if let Some(in_degrees) = is_in_degrees(recordings.channels[channel].unit.as_deref()) {
        return if in_degrees { 360.0 } else { turn };
    }
    let n = recordings.channels.len();
    let values = recordings.episodes.iter().flat_map(|raw| raw.positions.iter().skip(channel).step_by(n));
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &x| (low.min(x), high.max(x)));
    if high - low > 2.0 * turn { 360.0 } else { turn }
}

/// Rounds to three or four digits, without trailing zeros.
pub(crate) fn rounded(value: f64) -> String {
    let digits = format!("{value:.3e}");
    digits.parse::<f64>().map_or(digits, |value| format!("{value}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raw::{Records, Unknown};

    /// Two episodes of a state and an environment, with velocities.
    fn recordings(environment: [[f64; 2]; 2]) -> RawRecordings {
        let channel = |name: &str| Channel { name: name.to_owned(), unit: None };
        let episode = |(k, values): (usize, &[f64; 2])| RawEpisode {
            name: k.to_string(),
            file: String::new(),
            records: Records::consecutive(0, 2),
            times: vec![0.0, 0.1],
            positions: vec![1.0, values[0], 2.0, values[1]],
            velocities: vec![10.0, 0.0, 10.0, 0.0],
            constraint: None,
        };
        RawRecordings {
            channels: vec![channel("observation.state_0"), channel("observation.environment_state_0")],
            episodes: environment.iter().enumerate().map(episode).collect(),
            findings: vec![],
            word: "row",
            drop_constant: false,
            unknown: Unknown::default(),
            context: vec![],
        }
    }

    #[test]
    fn a_context_that_moves_without_velocity_is_refused() {
        let called = |environment| {
            let mut recordings = recordings(environment);
            recordings.channels[1].name = "target_x".to_owned();
            refuse_moving_context(&recordings).is_err()
        };
        assert!(called([[3.0, 3.5], [4.0, 4.0]]) && !called([[3.0, 3.0], [4.0, 4.0]]));
    }

    #[test]
    fn an_environment_stays_if_it_is_a_context() {
        let mut context = recordings([[3.0, 3.0], [4.0, 4.0]]);
        leave_out_moving_environment(&mut context, &[]);
        assert_eq!((context.channels.len(), context.findings.len()), (2, 0));
        for moving_or_same in [[[3.0, 3.5], [4.0, 4.0]], [[3.0, 3.0], [3.0, 3.0]]] {
            let mut other = recordings(moving_or_same);
            leave_out_moving_environment(&mut other, &[]);
            assert_eq!((other.channels.len(), other.findings.len()), (1, 1));
            assert_eq!(other.episodes[0].positions, [1.0, 2.0]);
            assert_eq!(other.episodes[1].velocities, [10.0, 10.0]);
        }
        // In one of several pieces, the channels read before decide.
        let mut same = recordings([[3.0, 3.0], [3.0, 3.0]]);
        let names = same.names();
        leave_out_moving_environment(&mut same, &names);
        assert_eq!((same.channels.len(), same.findings.len()), (2, 0));
        leave_out_moving_environment(&mut context, &["x".to_owned()]);
        assert_eq!(context.channels.len(), 1);
    }
}
