//! Named arrays side by side: one array per episode, one for all episodes, or one with the episodes in sequence.

use std::collections::HashMap;
use std::ops::Range;

use crate::arrays::array::{ArraySpec, Data, Load};
use crate::arrays::demo::families;
use crate::arrays::fields::assign;
use crate::arrays::grouped::GroupedArrays;
use crate::arrays::layout::{Stack, lengths};
use crate::arrays::reader::{ArrayReader, ReadState};
use crate::input::Input;
use crate::raw::{MOST_EPISODES, RawEpisode, RawRecordings, Records, even_times, no_time, period, seconds_since_first};
use crate::rows::roles::shortened;
use crate::rows::stamps::Stamp;
use crate::{Fault, ReadError};

pub(crate) fn recordings(
    input: &Input<'_>,
    described: &[ArraySpec],
    load: &mut Load<'_>,
) -> Result<RawRecordings, ReadError> {
    if let Some(demos) = families(described, input.options) {
        return GroupedArrays { input, described, demos, step: None, named_by_array: false }.recordings(load);
    }
    let fields = &assign(described, input.options, &input.name)?;
    Columns(ArrayReader { input, described, demo: None, arrays: described, fields, named_by_array: false })
        .recordings(load)
}

/// The arrays of a file, each of which holds all episodes.
struct Columns<'a>(ArrayReader<'a>);

impl Columns<'_> {
    fn recordings(&self, load: &mut Load<'_>) -> Result<RawRecordings, ReadError> {
        let ArrayReader { input, fields, described, .. } = self.0;
        // The short arrays are read first, because they may lead to an error.
        let step = match (period(input.options)?, fields.time) {
            (Some(step), _) => Some(vec![step]),
            (None, Some(_)) => None,
            (None, None) if fields.within.time.is_some() => None,
            (None, None) => self.0.steps(|_| true, load)?,
        };
        if step.is_none() && fields.time.is_none() && fields.within.time.is_none() {
            let listed: Vec<String> = described.iter().map(ArraySpec::with_shape).collect();
            let place = format!("{}, which holds {}", input.name, shortened(&listed));
            return Err(no_time(place, "the array of stamps"));
        }
        let ReadState { stack: state, velocities, channels, stamps, unused, unknown, context } = self.0.state(load)?;
        let ranges = self.ranges(&state, load)?;
        let times = match (&step, stamps) {
            (None, Some((stamps, name))) => {
                let mut unit = None;
                let seconds_of = |samples: &Samples| {
                    let stamps = samples.rows.iter().map(|&row| (Stamp::number(stamps[row]), None));
                    seconds_since_first(stamps, &name, input.options.time_unit, &mut unit)
                };
                ranges.iter().map(seconds_of).collect()
            }
            _ => self.times(&state, step, &ranges, load)?,
        };
        let names = self.0.labels(fields.episode_names, ranges.len(), load)?;
        let rows: Vec<&[usize]> = ranges.iter().map(|samples| &samples.rows[..]).collect();
        let mut labels = self.0.constraints(&rows, state.episodes * state.samples, load)?;
        let episodes = ranges.into_iter().zip(times).enumerate().map(|(index, (samples, times))| RawEpisode {
            name: names.as_ref().map_or_else(|| samples.name.clone(), |names| names[index].clone()),
            file: input.name.clone(),
            records: Records::consecutive(0, samples.rows.len()),
            times,
            positions: samples.of(&state.numbers, state.channels),
            velocities: if velocities.is_empty() { Vec::new() } else { samples.of(&velocities, state.channels) },
            constraint: labels[index].take(),
        });
        let (episodes, findings) = (episodes.collect(), self.0.findings(&unused));
        Ok(RawRecordings { channels, episodes, findings, word: "sample", drop_constant: false, unknown, context })
    }

    /// The samples of each episode.
    fn ranges(&self, state: &Stack, load: &mut Load<'_>) -> Result<Vec<Samples>, ReadError> {
        let ArrayReader { input, fields, described, .. } = self.0;
        let file = &input.name;
        let all = state.episodes * state.samples;
        let part = |name: usize, rows: Range<usize>| Samples { name: name.to_string(), rows: rows.collect() };
        if state.episodes > MOST_EPISODES {
            let what = format!("{} episodes, more than {MOST_EPISODES}", state.episodes);
            return Err(ReadError::TooLarge(Fault::new(what, file, "files with fewer episodes, or --samples-are")));
        }
        if described[fields.state[0]].shape.len() == 3 {
            return Ok((0..state.episodes).map(|k| part(k, k * state.samples..(k + 1) * state.samples)).collect());
        }
        if let Some(index) = fields.ends {
            let ends = load(index)?.numbers().unwrap_or_default();
            let mut start = 0;
            let mut ranges = Vec::new();
            for (k, end) in ends.into_iter().enumerate() {
                let end = end as usize;
                if end < start || end > all {
                    let what = format!("episode {k} ends at sample {end}, of {all}; the one before ends at {start}");
                    let place = format!("{file}, array '{}'", described[index].name);
                    let remedy = "ends that ascend up to the number of samples";
                    return Err(ReadError::Lengths(Fault::new(what, place, remedy)));
                }
                ranges.push(part(k, start..end));
                start = end;
            }
            return Ok(ranges);
        }
        match fields.episode {
            Some(field) => Ok(by_label(&self.0.by_sample(field, &[all], load)?)),
            None => Ok(vec![Samples { name: input.stem.clone(), rows: (0..all).collect() }]),
        }
    }

    /// Seconds of each episode.
    fn times(
        &self,
        state: &Stack,
        step: Option<Vec<f64>>,
        ranges: &[Samples],
        load: &mut Load<'_>,
    ) -> Result<Vec<Vec<f64>>, ReadError> {
        if let Some(steps) = step {
            if steps.len() != 1 && steps.len() != ranges.len() {
                return Err(lengths("time steps of episodes", ranges.len(), steps.len(), &self.0.input.name));
            }
            let each = steps.iter().cycle().zip(ranges);
            return Ok(each.map(|(&step, samples)| even_times(step, samples.rows.len())).collect());
        }
        let Some(field) = self.0.fields.time else { return Ok(Vec::new()) };
        let name = &self.0.arrays[field].name;
        // The stamps of one episode may apply to all episodes.
        let all = state.episodes * state.samples;
        let counts = if state.episodes > 1 { [all, state.samples] } else { [all; 2] };
        let stamps = self.0.by_sample(field, &counts, load)?;
        let mut unit = None;
        let times = ranges.iter().map(|samples| {
            let stamps = samples.rows.iter().map(|&row| stamps.stamp(row % stamps.len()));
            seconds_since_first(stamps, name, self.0.input.options.time_unit, &mut unit)
        });
        Ok(times.collect())
    }
}

/// Some samples of all.
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
    let mut known: HashMap<String, usize> = HashMap::new();
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
