//! Arrays with names, side by side: one array an episode, one array of all, or one after another.

use crate::arrays::array::{ArraySpec, Data, Load, unit_of};
use crate::arrays::fields::{Fields, assign, channel_names};
use crate::arrays::grouped::{GroupedArrays, families};
use crate::arrays::layout::{Stack, dimensions, lengths, stack};
use crate::input::Input;
use crate::raw::{Clock, MOST_EPISODES, RawEpisode, RawRecordings, Rows, no_time, period, unused};
use crate::rows::stamps::TicksPerSecond;
use crate::{Fault, ReadError};
use motion::{Channel, Finding};

pub(crate) fn drafts(
    input: &Input<'_>,
    described: &[ArraySpec],
    load: &mut Load<'_>,
) -> Result<RawRecordings, ReadError> {
    if let Some(demos) = families(described, input.options) {
        return GroupedArrays { input, described, demos, step: None, name_channels: |_, n| channel_names("x", n) }
            .drafts(load);
    }
    let set = Columns { input, described, fields: assign(described, input.options, &input.name)? };
    set.drafts(load)
}

/// The arrays of a file with their roles.
struct Columns<'a> {
    input: &'a Input<'a>,
    described: &'a [ArraySpec],
    fields: Fields,
}

impl Columns<'_> {
    fn drafts(&self, load: &mut Load<'_>) -> Result<RawRecordings, ReadError> {
        let Self { input, fields, .. } = self;
        let file = &input.name[..];
        // What is short is read first: it may refuse.
        let step = self.step(load)?;
        if step.is_none() && fields.time.is_none() {
            let place = format!("{file}, which holds {}", self.listed());
            return Err(no_time(place, "the array of stamps"));
        }
        let state = self.joined(&fields.state, load)?;
        let velocity = match &fields.velocity[..] {
            [] => None,
            arrays => Some(self.joined(arrays, load)?),
        };
        if let Some(velocity) = &velocity {
            let same = (velocity.episodes, velocity.samples, velocity.channels)
                == (state.episodes, state.samples, state.channels);
            if !same {
                return Err(self.differ(fields.velocity[0]));
            }
        }
        let channels = self.channels(state.channels, load)?;
        let mut findings: Vec<Finding> = self.coarse();
        let not_used: Vec<&str> = (0..self.described.len())
            .filter(|&index| !fields.uses(index))
            .map(|index| &self.described[index].name[..])
            .collect();
        findings.extend(unused("arrays", &not_used));
        let ranges = self.ranges(&state, load)?;
        let times = self.times(&state, step, &ranges, load)?;
        let names = self.texts(fields.episode_names, ranges.len(), load)?;
        let labels = self.texts(fields.constraint, ranges.len(), load)?;
        let episodes = ranges.into_iter().zip(times).enumerate().map(|(index, (samples, times))| RawEpisode {
            name: names.as_ref().map_or_else(|| samples.name.clone(), |names| names[index].clone()),
            file: file.to_owned(),
            rows: Rows::consecutive(0, samples.rows.len()),
            times,
            positions: samples.of(&state.numbers, state.channels),
            velocities: velocity
                .as_ref()
                .map_or_else(Vec::new, |velocity| samples.of(&velocity.numbers, state.channels)),
            constraint: labels.as_ref().map(|labels| labels[index].clone()).filter(|label| !label.is_empty()),
        });
        Ok(RawRecordings { channels, episodes: episodes.collect(), findings, word: "sample", drop_constant: false })
    }

    fn listed(&self) -> String {
        let listed: Vec<String> = self.described.iter().map(ArraySpec::with_shape).collect();
        crate::rows::roles::shortened(&listed)
    }

    fn coarse(&self) -> Vec<Finding> {
        self.fields.state.iter().filter_map(|&index| self.described[index].coarse(&self.input.name)).collect()
    }

    fn differ(&self, array: usize) -> ReadError {
        let state = &self.described[self.fields.state[0]];
        let what = format!("{} and {} differ in shape", state.with_shape(), self.described[array].with_shape());
        ReadError::Lengths(Fault::new(
            what,
            &self.input.name,
            "arrays of equal shape, or --ignore with the other's name",
        ))
    }

    fn joined(&self, arrays: &[usize], load: &mut Load<'_>) -> Result<Stack, ReadError> {
        let file = &self.input.name;
        let mut joined: Option<Stack> = None;
        for &index in arrays {
            let array = &self.described[index];
            // What would be refused is refused before it is read.
            dimensions(array, self.input, file)?;
            let numbers = load(index)?.numbers().ok_or_else(|| self.differ(index))?;
            let stack = stack(array, numbers, self.input, file)?;
            joined = Some(match joined {
                Some(joined) => joined.join(&stack, file)?,
                None => stack,
            });
        }
        joined.ok_or_else(|| crate::rows::roles::no_column("state", &[], file))
    }

    /// Seconds between samples, of each episode or of all: from the flag, or from an array of one number or K.
    fn step(&self, load: &mut Load<'_>) -> Result<Option<Vec<f64>>, ReadError> {
        if let Some(step) = period(self.input.options)? {
            return Ok(Some(vec![step]));
        }
        if self.fields.time.is_some() {
            return Ok(None);
        }
        let (index, is_rate) = match (self.fields.step, self.fields.rate) {
            (Some(step), _) => (step, false),
            (None, Some(rate)) => (rate, true),
            (None, None) => return Ok(None),
        };
        let name = &self.described[index].name;
        let values = load(index)?.numbers().unwrap_or_default();
        let steps: Vec<f64> = values.iter().map(|&value| if is_rate { 1.0 / value } else { value }).collect();
        if steps.is_empty() || steps.iter().any(|step| !(step.is_finite() && *step > 0.0)) {
            return Err(no_time(format!("{}, array '{name}' is no positive number", self.input.name), "stamps"));
        }
        Ok(Some(steps))
    }

    fn channels(&self, n: usize, load: &mut Load<'_>) -> Result<Vec<Channel>, ReadError> {
        let names = match self.fields.names.map(&mut *load).transpose()? {
            Some(Data::Text(names)) if names.len() == n => names,
            _ => channel_names("x", n),
        };
        let units = match self.fields.units.map(load).transpose()? {
            Some(Data::Text(units)) if units.len() == n => units,
            _ => vec![String::new(); n],
        };
        let channel = |(name, unit): (String, String)| Channel { name, unit: (!unit.is_empty()).then_some(unit) };
        Ok(names.into_iter().zip(units).map(channel).collect())
    }

    /// A label of each episode.
    fn texts(
        &self,
        array: Option<usize>,
        episodes: usize,
        load: &mut Load<'_>,
    ) -> Result<Option<Vec<String>>, ReadError> {
        let Some(index) = array else { return Ok(None) };
        if !self.described[index].is_number() && self.described[index].kind != crate::arrays::array::Kind::Text {
            return Ok(None);
        }
        let data = load(index)?;
        Ok((data.len() == episodes).then(|| (0..episodes).map(|at| data.label(at)).collect()))
    }

    /// Which samples each episode has.
    fn ranges(&self, state: &Stack, load: &mut Load<'_>) -> Result<Vec<Samples>, ReadError> {
        let file = &self.input.name;
        let all = state.episodes * state.samples;
        let part = |name: usize, rows: std::ops::Range<usize>| Samples { name: name.to_string(), rows: rows.collect() };
        if state.episodes > MOST_EPISODES {
            let what = format!("{} episodes, more than {MOST_EPISODES}", state.episodes);
            return Err(ReadError::TooLarge(Fault::new(what, file, "files with fewer episodes, or --samples-are")));
        }
        if self.described[self.fields.state[0]].shape.len() == 3 {
            return Ok((0..state.episodes).map(|k| part(k, k * state.samples..(k + 1) * state.samples)).collect());
        }
        if let Some(index) = self.fields.ends {
            let ends = load(index)?.numbers().unwrap_or_default();
            let mut start = 0;
            let mut ranges = Vec::new();
            for (k, end) in ends.into_iter().enumerate() {
                let end = end as usize;
                if end < start || end > all {
                    let what = format!("episode {k} ends at sample {end}, of {all}; the one before ends at {start}");
                    let place = format!("{file}, array '{}'", self.described[index].name);
                    return Err(ReadError::Lengths(Fault::new(
                        what,
                        place,
                        "ends that ascend up to the number of samples",
                    )));
                }
                ranges.push(part(k, start..end));
                start = end;
            }
            return Ok(ranges);
        }
        let Some(index) = self.fields.episode else {
            let name = self.input.stem.clone();
            return Ok(vec![Samples { name, rows: (0..all).collect() }]);
        };
        let labels = load(index)?;
        if labels.len() != all {
            return Err(lengths(&format!("array '{}'", self.described[index].name), all, labels.len(), file));
        }
        Ok(by_label(&labels))
    }

    /// Seconds of each episode.
    fn times(
        &self,
        state: &Stack,
        step: Option<Vec<f64>>,
        ranges: &[Samples],
        load: &mut Load<'_>,
    ) -> Result<Vec<Vec<f64>>, ReadError> {
        let file = &self.input.name;
        if let Some(steps) = step {
            if steps.len() != 1 && steps.len() != ranges.len() {
                return Err(lengths("time steps of episodes", ranges.len(), steps.len(), file));
            }
            let step = |k: usize| if steps.len() == 1 { steps[0] } else { steps[k] };
            let even = |k: usize| Clock::Even(step(k)).seconds(ranges[k].rows.len(), TicksPerSecond(1.0));
            return Ok((0..ranges.len()).map(even).collect());
        }
        let Some(index) = self.fields.time else { return Ok(Vec::new()) };
        let stamps = load(index)?;
        let name = &self.described[index].name;
        let all = state.episodes * state.samples;
        let shared = stamps.len() == state.samples && state.episodes > 1;
        if stamps.len() != all && !shared {
            return Err(lengths(&format!("array '{name}'"), all, stamps.len(), file));
        }
        let mut ticks = None;
        let times = ranges.iter().map(|samples| {
            let mut clock = Clock::new(None);
            for &row in &samples.rows {
                let (stamp, unit) = stamps.stamp(if shared { row % state.samples } else { row });
                ticks = ticks.or_else(|| stamp.is_finite().then(|| unit_of(name, stamp, unit)));
                clock.push(stamp);
            }
            clock.seconds(samples.rows.len(), ticks.unwrap_or(TicksPerSecond(1.0)))
        });
        Ok(times.collect())
    }
}

/// Some samples of a whole.
struct Samples {
    name: String,
    rows: Vec<usize>,
}

impl Samples {
    fn of(&self, numbers: &[f64], n: usize) -> Vec<f64> {
        self.rows.iter().flat_map(|&row| &numbers[row * n..(row + 1) * n]).copied().collect()
    }
}

/// Samples by label, in the order in which labels appear.
fn by_label(labels: &Data) -> Vec<Samples> {
    let mut known: std::collections::HashMap<String, usize> = std::collections::HashMap::new();
    let mut episodes: Vec<Samples> = Vec::new();
    for row in 0..labels.len() {
        let label = labels.label(row);
        let episode = *known.entry(label).or_insert_with_key(|label| {
            episodes.push(Samples { name: label.clone(), rows: Vec::new() });
            episodes.len() - 1
        });
        episodes[episode].rows.push(row);
    }
    episodes
}
