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
pub(crate) fn clean(drafts: &mut RawRecordings, channels: &[String], options: &ReadOptions) -> Result<(), ReadError> {
    positive(options.split_gap, "--split-gap")?;
    if drafts.drop_constant {
        leave_out_constant(drafts, channels);
    }
    if options.context.is_empty() {
        leave_out_moving_environment(drafts, channels);
        refuse_moving_context(drafts)?;
    }
    name_units(drafts, options)?;
    degrees_to_radians(drafts, options)?;
    let names = drafts.names();
    let mut episodes = Vec::with_capacity(drafts.episodes.len());
    let (mut missing, mut samples) = (0, 0);
    for mut draft in drafts.episodes.drain(..) {
        samples += draft.len();
        missing += make_finite(&mut draft, &names, drafts.word, options.nan)?;
        if options.sort {
            sort(&mut draft);
        }
        if let Some(longest) = options.split_gap {
            episodes.extend(split(draft, longest));
        } else {
            refuse_backwards(&draft, drafts.word)?;
            episodes.push(draft);
        }
    }
    drafts.findings.extend(not_recorded(missing, samples, options.nan));
    for draft in &mut episodes {
        from_zero(draft);
        drafts.findings.extend(leave_out_duplicates(draft, drafts.word));
    }
    drafts.episodes = episodes;
    unwrap_angles(drafts, options)?;
    Ok(())
}

/// Drops unnamed columns that never change, such as a stopped counter or a sensor that is off; they are no state. `known` are the
/// channels of other recordings.
fn leave_out_constant(drafts: &mut RawRecordings, known: &[String]) {
    let n = drafts.channels.len();
    let mut first: Vec<f64> = vec![f64::NAN; n];
    let mut changes: Vec<bool> = drafts.channels.iter().map(|channel| known.contains(&channel.name)).collect();
    for draft in &drafts.episodes {
        for sample in draft.positions.chunks_exact(n) {
            for ((first, changes), &value) in first.iter_mut().zip(&mut changes).zip(sample) {
                if first.is_nan() {
                    *first = value;
                }
                *changes |= value != *first && !value.is_nan();
            }
        }
    }
    let recorded = drafts.episodes.iter().any(|draft| !draft.velocities.is_empty());
    if recorded || changes.iter().all(|&changes| changes) || !changes.contains(&true) {
        return;
    }
    let constant = drafts.channels.iter().zip(&changes).filter(|(_, changes)| !**changes);
    let names: Vec<&str> = constant.map(|(channel, _)| &channel.name[..]).collect();
    let what = format!("constant columns are not taken as state: {}", roles::shortened(&names));
    drafts.findings.push(remark(what, "--state with their names takes them"));
    retain_channels(drafts, &changes);
}

/// Drops the channels that do not stay, with their numbers.
fn retain_channels(drafts: &mut RawRecordings, stays: &[bool]) {
    let mut column = stays.iter();
    drafts.channels.retain(|_| *column.next().unwrap_or(&true));
    for numbers in drafts.episodes.iter_mut().flat_map(|draft| [&mut draft.positions, &mut draft.velocities]) {
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
fn leave_out_moving_environment(drafts: &mut RawRecordings, channels: &[String]) {
    let n = drafts.channels.len();
    let is_environment = |channel: &Channel| channel.name.starts_with(ENVIRONMENT);
    let stays: Vec<bool> = drafts.channels.iter().map(|channel| !is_environment(channel)).collect();
    if stays.iter().all(|&stays| stays) {
        return;
    }
    let part = |sample: &[f64]| -> Vec<f64> {
        sample.iter().zip(&stays).filter(|(_, stays)| !**stays).map(|(value, _)| *value).collect()
    };
    let mut firsts = drafts.episodes.iter().filter_map(|draft| draft.positions.chunks_exact(n).next()).map(part);
    let first = firsts.next();
    let differs = firsts.any(|other| Some(&other) != first.as_ref());
    let moves = |draft: &RawEpisode| {
        let mut samples = draft.positions.chunks_exact(n).map(part);
        let first = samples.next();
        samples.any(|sample| Some(&sample) != first.as_ref())
    };
    let is_context = if channels.is_empty() {
        differs && !drafts.episodes.iter().any(moves)
    } else {
        channels.iter().any(|name| name.starts_with(ENVIRONMENT))
    };
    if is_context {
        return;
    }
    let names: Vec<&str> =
        drafts.channels.iter().filter(|channel| is_environment(channel)).map(|channel| &channel.name[..]).collect();
    drafts.findings.extend(unused("columns", &names, &[]));
    retain_channels(drafts, &stays);
}

/// Refuses a channel that is named like a context and changes within an episode, if velocities are recorded and its are all 0.
fn refuse_moving_context(drafts: &RawRecordings) -> Result<(), ReadError> {
    let n = drafts.channels.len();
    let of = |numbers: &[f64], channel: usize| numbers.iter().skip(channel).step_by(n).copied().collect::<Vec<_>>();
    for (channel, described) in drafts.channels.iter().enumerate().filter(|(_, of)| is_called_context(&of.name)) {
        let without = |draft: &RawEpisode| {
            !draft.velocities.is_empty() && of(&draft.velocities, channel).iter().all(|&velocity| velocity == 0.0)
        };
        let moves = |draft: &&RawEpisode| of(&draft.positions, channel).windows(2).any(|pair| pair[0] != pair[1]);
        let Some(moving) = drafts.episodes.iter().find(moves) else { continue };
        if drafts.episodes.iter().all(without) {
            let what = format!("'{}' changes within an episode and has no velocity", described.name);
            let remedy =
                format!("--ignore '{}', or --state and --velocity with the columns of the state", described.name);
            return Err(ReadError::NoRoles(Fault::new(what, moving.place(0, drafts.word), remedy)));
        }
    }
    Ok(())
}

/// Applies `--units m`, `--units x=mm`.
fn name_units(drafts: &mut RawRecordings, options: &ReadOptions) -> Result<(), ReadError> {
    let names = drafts.names();
    for assignment in options.units.iter().flat_map(|text| text.split(',')) {
        let (pattern, unit) = assignment.split_once('=').unwrap_or(("*", assignment));
        for channel in named(&[pattern.trim().to_owned()], &names, "--units")? {
            drafts.channels[channel].unit = Some(unit.trim().to_owned());
        }
    }
    Ok(())
}

/// The channels that match a flag's patterns.
fn named(patterns: &[String], names: &[String], flag: &str) -> Result<Vec<usize>, ReadError> {
    roles::named(patterns, names, &format!("{flag}, among the channels of the state"))
}

fn degrees_to_radians(drafts: &mut RawRecordings, options: &ReadOptions) -> Result<(), ReadError> {
    let names = drafts.names();
    for channel in named(&options.degrees, &names, "--degrees")? {
        drafts.channels[channel].unit = Some("rad".to_owned());
        for draft in &mut drafts.episodes {
            for numbers in [&mut draft.positions, &mut draft.velocities] {
                for value in numbers.iter_mut().skip(channel).step_by(names.len()) {
                    *value = value.to_radians();
                }
            }
        }
    }
    Ok(())
}

/// Sorts samples by stamp, stably.
fn sort(draft: &mut RawEpisode) {
    let mut order: Vec<usize> = (0..draft.len()).collect();
    order.sort_by(|&a, &b| draft.times[a].total_cmp(&draft.times[b]));
    *draft = draft.chosen(order.iter().copied());
}

fn refuse_backwards(draft: &RawEpisode, word: &str) -> Result<(), ReadError> {
    let Some(at) = draft.times.windows(2).position(|pair| pair[1] < pair[0]) else { return Ok(()) };
    let what = format!("stamps go back by {} s", rounded(draft.times[at] - draft.times[at + 1]));
    let cut = "--split-gap 1 if a new movement begins here (cuts where stamps go back or pause for 1 s)";
    let sort = "--sort (puts samples in the order of their stamps)";
    let begins_again = draft.times[at + 1] - draft.times[0] <= BEGINNING * (draft.times[at] - draft.times[0]);
    let (first, second) = if begins_again { (cut, sort) } else { (sort, cut) };
    let remedy = format!("{first}, or {second}");
    Err(ReadError::TimeBackwards(Fault::new(what, draft.place(at + 1, word), remedy)))
}

/// Shifts times to seconds from the first sample. Stamps that this rounds to the same value become equal.
fn from_zero(draft: &mut RawEpisode) {
    let first = draft.times.first().copied().unwrap_or(0.0);
    draft.times.iter_mut().for_each(|time| *time -= first);
}

/// Keeps the first of samples with equal stamps.
fn leave_out_duplicates(draft: &mut RawEpisode, word: &str) -> Option<Finding> {
    let duplicate = |sample: &usize| *sample > 0 && draft.times[*sample] == draft.times[sample - 1];
    let first = (0..draft.len()).find(duplicate)?;
    let retained: Vec<usize> = (0..draft.len()).filter(|sample| !duplicate(sample)).collect();
    let more = match draft.len() - retained.len() {
        1 => String::new(),
        duplicates => format!(" (and {} more)", duplicates - 1),
    };
    let what = format!("{}: a stamp occurs twice; kept the first of its samples{more}", draft.place(first, word));
    *draft = draft.chosen(retained.iter().copied());
    Some(remark(what, "check the recorder's clock"))
}

/// Cuts an episode where stamps go back, or are more than `longest` seconds apart.
fn split(draft: RawEpisode, longest: f64) -> Vec<RawEpisode> {
    let mut cuts: Vec<usize> = vec![0];
    let passed = |sample: usize| draft.times[sample] - draft.times[sample - 1];
    cuts.extend((1..draft.len()).filter(|&sample| passed(sample) < 0.0 || passed(sample) > longest));
    cuts.push(draft.len());
    if cuts.len() == 2 {
        return vec![draft];
    }
    let part = |(number, cut): (usize, &[usize])| {
        let name = format!("{}_{number}", draft.name);
        RawEpisode { name, ..draft.chosen(cut[0]..cut[1]) }
    };
    cuts.windows(2).enumerate().map(part).collect()
}

/// Makes the named angles continuous.
fn unwrap_angles(drafts: &mut RawRecordings, options: &ReadOptions) -> Result<(), ReadError> {
    let names = drafts.names();
    if options.unwrap.iter().any(|pattern| pattern != "*") {
        named(&options.unwrap, &names, "--unwrap")?;
    }
    for (channel, _) in flags(&options.unwrap, &names).iter().enumerate().filter(|(_, chosen)| **chosen) {
        let turn = whole_turn(drafts, channel);
        for RawEpisode { positions, velocities, times, .. } in &mut drafts.episodes {
            let seconds = |sample: usize| times[sample] - times[sample - 1];
            unwrap_angle(positions, velocities, (names.len(), channel), turn, seconds);
        }
    }
    Ok(())
}

/// A whole turn in a channel's unit. Without a unit it is radians, unless its values cover more than two turns.
fn whole_turn(drafts: &RawRecordings, channel: usize) -> f64 {
    let turn = std::f64::consts::TAU;
    if let Some(in_degrees) = is_in_degrees(drafts.channels[channel].unit.as_deref()) {
        return if in_degrees { 360.0 } else { turn };
    }
    let n = drafts.channels.len();
    let values = drafts.episodes.iter().flat_map(|draft| draft.positions.iter().skip(channel).step_by(n));
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
    use crate::raw::{Rows, Unknown};

    /// Two episodes of a state and an environment, with velocities.
    fn drafts(environment: [[f64; 2]; 2]) -> RawRecordings {
        let channel = |name: &str| Channel { name: name.to_owned(), unit: None };
        let episode = |(k, values): (usize, &[f64; 2])| RawEpisode {
            name: k.to_string(),
            file: String::new(),
            rows: Rows::consecutive(0, 2),
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
            let mut drafts = drafts(environment);
            drafts.channels[1].name = "target_x".to_owned();
            refuse_moving_context(&drafts).is_err()
        };
        assert!(called([[3.0, 3.5], [4.0, 4.0]]) && !called([[3.0, 3.0], [4.0, 4.0]]));
    }

    #[test]
    fn an_environment_stays_if_it_is_a_context() {
        let mut context = drafts([[3.0, 3.0], [4.0, 4.0]]);
        leave_out_moving_environment(&mut context, &[]);
        assert_eq!((context.channels.len(), context.findings.len()), (2, 0));
        for moving_or_same in [[[3.0, 3.5], [4.0, 4.0]], [[3.0, 3.0], [3.0, 3.0]]] {
            let mut other = drafts(moving_or_same);
            leave_out_moving_environment(&mut other, &[]);
            assert_eq!((other.channels.len(), other.findings.len()), (1, 1));
            assert_eq!(other.episodes[0].positions, [1.0, 2.0]);
            assert_eq!(other.episodes[1].velocities, [10.0, 10.0]);
        }
        // In one of several pieces, the channels read before decide.
        let mut same = drafts([[3.0, 3.0], [3.0, 3.0]]);
        let names = same.names();
        leave_out_moving_environment(&mut same, &names);
        assert_eq!((same.channels.len(), same.findings.len()), (2, 0));
        leave_out_moving_environment(&mut context, &["x".to_owned()]);
        assert_eq!(context.channels.len(), 1);
    }
}
