use crate::arrays::layout::lengths;
use crate::input::Input;
use crate::names::columns::{Asked, Chosen};
use crate::names::selection::flags;
use crate::raw::{
    MOST_EPISODES, RawEpisode, RawRecordings, Records, Unknown, counted_names, even_times, no_time, period,
    seconds_since_first, unused,
};
use crate::rows::json::Json;
use crate::rows::stamps::Stamp;
use crate::{Fault, ReadError, ReadOptions};
use motion::{Channel, Labels};

/// Episodes, one per line: `{"episode": "take 1", "dt": 0.05, "names": ["x"], "unit": ["m"], "state": [[0.1], [0.2]],
/// "velocity": [[2.0], [2.0]], "constraint": "rail"}`. `times` may replace `dt`, and a list may give the constraint of each
/// sample.
pub(super) struct EpisodeLines<'a> {
    input: &'a Input<'a>,
    /// The word for an episode: "line".
    word: &'static str,
    channels: Option<Vec<Channel>>,
    /// Number of episodes before the first of `episodes`.
    before: usize,
    episodes: Vec<RawEpisode>,
}

/// The value of the first existing key.
fn one_of<'a>(line: &'a Json, keys: &[&str]) -> Option<&'a Json> {
    keys.iter().find_map(|key| line.get(key)).filter(|value| **value != Json::Null)
}

/// The samples of a line that holds an episode.
pub(super) fn state(line: &Json) -> Option<&[Json]> {
    let samples = one_of(line, &["state", "states", "positions", "position"])?.list()?;
    samples.first().is_some_and(|sample| sample.list().is_some()).then_some(samples)
}

impl<'a> EpisodeLines<'a> {
    pub(super) fn new(input: &'a Input<'a>, word: &'static str) -> Self {
        Self { input, word, channels: None, before: 0, episodes: Vec::new() }
    }

    /// Forgets all episodes and continues after the first `before` episodes; the channels stay those of the first.
    pub(super) fn forget(&mut self, before: usize) {
        self.episodes.clear();
        self.before = before;
    }

    pub(super) fn push(&mut self, number: u64, line: &Json) -> Result<(), ReadError> {
        let place = format!("{}, {} {number}", self.input.name, self.word);
        let other_form = |what: &str| {
            let remedy = "lines like {\"episode\": \"1\", \"dt\": 0.05, \"names\": [\"x\"], \"state\": [[0.1], [0.2]]}";
            ReadError::Json(Fault::new(what, &place, remedy))
        };
        let samples = state(line).ok_or_else(|| other_form("there is no 'state' with a list of samples"))?;
        let n = samples[0].list().map_or(0, <[Json]>::len);
        if n == 0 {
            return Err(other_form("a sample has no number"));
        }
        crate::arrays::fields::too_many_channels(n, "columns", &place)?;
        if self.episodes.len() == MOST_EPISODES {
            let remedy = "files with fewer episodes";
            return Err(ReadError::TooLarge(Fault::new(format!("more than {MOST_EPISODES} episodes"), place, remedy)));
        }
        let positions = numbers(samples, n, "state", &place)?;
        let velocities = match one_of(line, &["velocity", "velocities"]) {
            None => Vec::new(),
            Some(velocity) => {
                let velocity = velocity.list().ok_or_else(|| other_form("'velocity' is not a list of samples"))?;
                if velocity.len() != samples.len() {
                    return Err(lengths("'velocity'", samples.len(), velocity.len(), &place));
                }
                numbers(velocity, n, "velocity", &place)?
            }
        };
        let channels = channels(line, n);
        match &self.channels {
            Some(known) if *known != channels => {
                return Err(other_form("names, units or number of channels differ from the first line's"));
            }
            _ => self.channels = Some(channels),
        }
        let label = |keys: &[&str]| one_of(line, keys).map(Json::to_string);
        self.episodes.push(RawEpisode {
            name: label(&["episode", "name"]).unwrap_or_else(|| (self.before + self.episodes.len()).to_string()),
            file: self.input.name.clone(),
            records: Records::consecutive(0, samples.len()),
            times: self.times(line, samples.len(), &place)?,
            positions,
            velocities,
            constraint: constraints(line, samples.len(), &place)?,
        });
        Ok(())
    }

    fn times(&self, line: &Json, len: usize, place: &str) -> Result<Vec<f64>, ReadError> {
        let asked = period(self.input.options)?;
        let step = asked.or_else(|| one_of(line, &["dt", "time_step"])?.number());
        if let (None, Some((name, stamps))) = (asked, stamps(line)) {
            if stamps.len() != len {
                return Err(lengths(&format!("'{name}'"), len, stamps.len(), place));
            }
            let stamps = stamps.iter().map(|stamp| stamp.stamp().unwrap_or((Stamp::MISSING, None)));
            return Ok(seconds_since_first(stamps, name, self.input.options.time_unit, &mut None));
        }
        match step {
            Some(step) if step.is_finite() && step > 0.0 => Ok(even_times(step, len)),
            _ => Err(no_time(place, "'dt' or 'times' in each line")),
        }
    }

    /// Selects the user's channels.
    pub(super) fn finish(self) -> Result<RawRecordings, ReadError> {
        let ReadOptions { state, velocity, context, ignore, .. } = self.input.options.clone();
        let (channels, mut episodes) = (self.channels.unwrap_or_default(), self.episodes);
        let names: Vec<String> = channels.iter().map(|channel| channel.name.clone()).collect();
        let unknown = Unknown::of(&ignore, &names);
        let asked = Asked { state, velocity, context, ignore, time: None };
        let recordings = |channels, findings, episodes, context| RawRecordings {
            channels,
            episodes,
            findings,
            word: "sample",
            drop_constant: false,
            unknown: unknown.clone(),
            context,
        };
        if asked.is_empty() {
            return Ok(recordings(channels, Vec::new(), episodes, Vec::new()));
        }
        let chosen = Chosen::of(&names, &asked, &[], &self.input.name)?;
        for raw in &mut episodes {
            raw.velocities = chosen.velocities(&raw.positions, &raw.velocities, &self.input.name)?;
            raw.positions = chosen.positions(&raw.positions);
        }
        let ignored = flags(&asked.ignore, &names);
        let left: Vec<&str> = chosen.unused().filter(|&column| !ignored[column]).map(|at| &names[at][..]).collect();
        let channels = chosen.channels().map(|column| channels[column].clone()).collect();
        let findings = unused("columns", &left, &self.input.options.elsewhere).into_iter().collect();
        let context = chosen.context.iter().map(|&column| names[column].clone()).collect();
        Ok(recordings(channels, findings, episodes, context))
    }
}

/// Names of constraints: one for the line, or one for each sample.
fn constraints(line: &Json, samples: usize, place: &str) -> Result<Option<Labels>, ReadError> {
    match one_of(line, &["constraint", "condition"]) {
        Some(Json::List(names)) if names.len() != samples => Err(lengths("'constraint'", samples, names.len(), place)),
        Some(Json::List(names)) => Ok(Labels::of_samples(names.iter().map(Json::to_string))),
        Some(name) => Ok(Some(Labels::from(name.to_string()))),
        None => Ok(None),
    }
}

fn stamps(line: &Json) -> Option<(&str, &[Json])> {
    ["times", "t", "time", "timestamps", "timestamp"].into_iter().find_map(|key| Some((key, line.get(key)?.list()?)))
}

/// All samples, one after another.
fn numbers(samples: &[Json], n: usize, key: &str, place: &str) -> Result<Vec<f64>, ReadError> {
    let mut numbers = Vec::with_capacity(samples.len() * n);
    for (at, sample) in samples.iter().enumerate() {
        let values = sample.list().unwrap_or_default();
        let place = || format!("{place}, '{key}', sample {at}");
        if values.len() != n {
            let what = format!("{} numbers where {n} are expected", values.len());
            return Err(ReadError::Ragged(Fault::new(what, place(), "samples of equal length")));
        }
        for value in values {
            numbers.push(value.number().ok_or_else(|| {
                let remedy = "numbers, or null where one is missing";
                ReadError::NotANumber(Fault::new(format!("'{value}' is not a number"), place(), remedy))
            })?);
        }
    }
    Ok(numbers)
}

fn channels(line: &Json, n: usize) -> Vec<Channel> {
    let texts = |keys: &[&str]| -> Option<Vec<String>> {
        let texts = one_of(line, keys)?.list()?.iter().map(|text| text.text().map(str::to_owned));
        texts.collect::<Option<Vec<_>>>().filter(|texts| texts.len() == n)
    };
    let units: Vec<Option<String>> = match one_of(line, &["unit", "units"]) {
        Some(Json::Text(unit)) => vec![Some(unit.clone()); n],
        Some(Json::List(units)) if units.len() == n => {
            units.iter().map(|unit| unit.text().map(str::to_owned)).collect()
        }
        _ => vec![None; n],
    };
    let names = texts(&["names", "columns"]).unwrap_or_else(|| counted_names(n));
    names.into_iter().zip(units).map(|(name, unit)| Channel { name, unit }).collect()
}
