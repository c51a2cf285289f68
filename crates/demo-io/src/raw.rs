//! Unchecked episodes, as readers return them.

use crate::names::selection::{flags, unmatched};
use crate::rows::stamps::Stamp;
use motion::{Channel, Episode, Finding, Labels, RecordRange, Recordings, Source, Times};
use nalgebra::DMatrix;

use crate::error::in_one_line;
use crate::{Fault, ReadError, ReadOptions, TimeUnit};

/// The result of a reader.
#[derive(Debug)]
pub(crate) struct RawRecordings {
    pub(crate) channels: Vec<Channel>,
    pub(crate) episodes: Vec<RawEpisode>,
    pub(crate) findings: Vec<Finding>,
    /// The unit that [`Records`] counts: "line", "row", "message", "sample".
    pub(crate) word: &'static str,
    /// Whether the state was detected rather than named, so that columns that never change are dropped.
    pub(crate) drop_constant: bool,
    /// Patterns of `--ignore` that match nothing.
    pub(crate) unknown: Unknown,
    /// Names of the channels that the user selects as context.
    pub(crate) context: Vec<String>,
}

/// Patterns that match nothing, and the existing names.
#[derive(Debug, Clone, Default)]
pub(crate) struct Unknown {
    pub(crate) patterns: Vec<String>,
    pub(crate) names: Vec<String>,
}

impl Unknown {
    pub(crate) fn of<S: AsRef<str>>(patterns: &[String], names: &[S]) -> Self {
        let unmatched = unmatched(patterns, names);
        let names =
            if unmatched.is_empty() { Vec::new() } else { names.iter().map(|name| name.as_ref().to_owned()).collect() };
        Unknown { patterns: unmatched, names }
    }
}

/// An episode of n channels and N samples.
#[derive(Debug)]
pub(crate) struct RawEpisode {
    pub(crate) name: String,
    /// File name without folders.
    pub(crate) file: String,
    pub(crate) records: Records,
    /// (N), in seconds, with any origin.
    pub(crate) times: Vec<f64>,
    /// Sample after sample, n N numbers; a missing one is NaN.
    pub(crate) positions: Vec<f64>,
    /// As many as positions, or empty.
    pub(crate) velocities: Vec<f64>,
    pub(crate) constraint: Option<Labels>,
}

/// Maximum number of episodes, and of channels.
pub(crate) const MOST_EPISODES: usize = 1_000_000;
pub(crate) const MOST_CHANNELS: usize = 4096;

impl RawRecordings {
    /// Names of the n channels.
    pub(crate) fn names(&self) -> Vec<String> {
        self.channels.iter().map(|channel| channel.name.clone()).collect()
    }

    /// Brings the channels into the order of `channels`, if they are the same.
    pub(crate) fn order_as(&mut self, channels: &[Channel]) {
        let n = channels.len();
        if self.channels == channels || self.channels.len() != n {
            return;
        }
        let at = |channel: &Channel| self.channels.iter().position(|own| own == channel);
        let Some(order) = channels.iter().map(at).collect::<Option<Vec<usize>>>() else { return };
        for episode in &mut self.episodes {
            for numbers in [&mut episode.positions, &mut episode.velocities] {
                *numbers = numbers.chunks_exact(n).flat_map(|sample| order.iter().map(|&at| sample[at])).collect();
            }
        }
        self.channels = channels.to_vec();
    }

    /// Converts to the type that other crates use.
    pub(crate) fn checked(self) -> Recordings {
        let RawRecordings { channels, episodes, findings, word, .. } = self;
        let n = channels.len();
        let matrix = |numbers: Vec<f64>| DMatrix::from_vec(n, numbers.len().checked_div(n).unwrap_or(0), numbers);
        let episodes = episodes.into_iter().map(|raw| Episode {
            source: Source { file: raw.file, records: raw.records.ends(word) },
            name: raw.name,
            times: Times::Stamped(raw.times),
            velocities: (!raw.velocities.is_empty()).then(|| matrix(raw.velocities)),
            positions: matrix(raw.positions),
            constraint: raw.constraint,
            context: nalgebra::DVector::zeros(0),
        });
        Recordings { state: channels, episodes: episodes.collect(), findings }
    }
}

impl RawEpisode {
    pub(crate) fn len(&self) -> usize {
        self.times.len()
    }

    /// The selected samples, in the given order.
    pub(crate) fn chosen(&self, samples: impl Iterator<Item = usize> + Clone) -> RawEpisode {
        // Velocities may be missing.
        let columns = |numbers: &[f64]| -> Vec<f64> {
            let n = numbers.len().checked_div(self.len()).unwrap_or(0);
            samples.clone().flat_map(|sample| &numbers[sample * n..(sample + 1) * n]).copied().collect()
        };
        let (positions, velocities) = (columns(&self.positions), columns(&self.velocities));
        let records = samples.clone().map(|sample| self.records.at(sample)).collect();
        let constraint = self.constraint.as_ref().and_then(|labels| labels.chosen(samples.clone()));
        let times = samples.map(|sample| self.times[sample]).collect();
        let (name, file) = (self.name.clone(), self.file.clone());
        RawEpisode { name, file, records, times, positions, velocities, constraint }
    }

    /// The place of `sample` in the file: "demos.csv, line 17 (episode 1)".
    pub(crate) fn place(&self, sample: usize, word: &str) -> String {
        let Self { name, file, records, .. } = self;
        match word {
            "sample" => format!("{file}, episode {name}, sample {}", records.at(sample)),
            _ => format!("{file}, {word} {} (episode {name})", records.at(sample)),
        }
    }
}

/// The place of each sample in the file, as runs of consecutive places: a few bytes for most episodes.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Records {
    /// The first sample of each run and its place.
    runs: Vec<(usize, u64)>,
    len: usize,
}

impl Records {
    /// `len` places from `first`.
    pub(crate) fn consecutive(first: u64, len: usize) -> Self {
        Self { runs: vec![(0, first)], len }
    }

    pub(crate) fn len(&self) -> usize {
        self.len
    }

    pub(crate) fn push(&mut self, place: u64) {
        let follows = self.runs.last().is_some_and(|&(sample, first)| first + (self.len - sample) as u64 == place);
        if !follows {
            self.runs.push((self.len, place));
        }
        self.len += 1;
    }

    pub(crate) fn at(&self, sample: usize) -> u64 {
        let run = self.runs.partition_point(|&(first, _)| first <= sample);
        self.runs.get(run.wrapping_sub(1)).map_or(0, |&(first, place)| place + (sample - first) as u64)
    }

    pub(crate) fn ends(&self, word: &'static str) -> Option<RecordRange> {
        (self.len > 0).then(|| RecordRange { word, first: self.at(0), last: self.at(self.len - 1) })
    }
}

impl FromIterator<u64> for Records {
    fn from_iter<I: IntoIterator<Item = u64>>(places: I) -> Self {
        let mut records = Records::default();
        places.into_iter().for_each(|place| records.push(place));
        records
    }
}

/// The source of an episode's times.
#[derive(Debug)]
pub(crate) enum Clock {
    /// Samples at this interval, in seconds.
    Even(f64),
    /// Stamps, in units since the first.
    Stamps { first: Option<Stamp>, since: Vec<f64> },
}

impl Clock {
    pub(crate) fn new(period: Option<f64>) -> Self {
        period.map_or(Clock::Stamps { first: None, since: Vec::new() }, Clock::Even)
    }

    pub(crate) fn push(&mut self, stamp: Stamp) {
        if let Clock::Stamps { first, since } = self {
            if first.is_none() && stamp.is_finite() {
                *first = Some(stamp);
            }
            since.push(first.map_or(f64::NAN, |first| stamp.since(first)));
        }
    }

    /// The times of `len` samples, in seconds.
    pub(crate) fn seconds(self, len: usize, unit: TimeUnit) -> Vec<f64> {
        match self {
            Clock::Even(period) => even_times(period, len),
            Clock::Stamps { mut since, .. } => {
                if unit != TimeUnit::Seconds {
                    for time in &mut since {
                        *time /= unit.per_second();
                    }
                }
                since
            }
        }
    }
}

/// `x0`, `x1` and so on, for a file that does not name its n channels.
pub(crate) fn counted_names(n: usize) -> Vec<String> {
    (0..n).map(|channel| format!("x{channel}")).collect()
}

/// Times of `len` samples, `step` seconds apart.
pub(crate) fn even_times(step: f64, len: usize) -> Vec<f64> {
    (0..len).map(|sample| sample as f64 * step).collect()
}

/// Converts stamps to seconds since the first. They count in `unit` if it is known, else the unit in the first stamp, else
/// the user's, else a guess from `name` and the size of the stamp.
pub(crate) fn seconds_since_first(
    stamps: impl Iterator<Item = (Stamp, Option<TimeUnit>)>,
    name: &str,
    asked: Option<TimeUnit>,
    unit: &mut Option<TimeUnit>,
) -> Vec<f64> {
    let mut clock = Clock::new(None);
    for (stamp, stated) in stamps {
        let found = || stamp.is_finite().then(|| stated.or(asked).unwrap_or_else(|| stamp.unit(name)));
        *unit = unit.or_else(found);
        clock.push(stamp);
    }
    clock.seconds(0, unit.unwrap_or(TimeUnit::Seconds))
}

/// Checks that the seconds of a flag are above 0.
pub(crate) fn positive(seconds: Option<f64>, flag: &str) -> Result<Option<f64>, ReadError> {
    match seconds {
        Some(value) if !(value.is_finite() && value > 0.0) => {
            let (what, remedy) = (format!("{flag} is {value}"), format!("{flag} with seconds above 0"));
            Err(ReadError::Option(Fault::new(what, "the flags", remedy)))
        }
        _ => Ok(seconds),
    }
}

/// `--dt`: seconds between samples.
pub(crate) fn period(options: &ReadOptions) -> Result<Option<f64>, ReadError> {
    positive(options.dt, "--dt")
}

pub(crate) fn no_time(place: impl Into<String>, what_is_time: &str) -> ReadError {
    let what = "neither stamps nor a time step are known";
    let remedy = format!("--dt SECONDS (the time between samples), or --time with {what_is_time}");
    ReadError::NoTime(Fault::new(what, place, remedy))
}

/// A finding that did not prevent reading.
pub(crate) fn remark(what: impl Into<String>, next: impl Into<String>) -> Finding {
    Finding::remark(in_one_line(what.into()), in_one_line(next.into()))
}

/// A finding on unused names except those in `elsewhere`; `None` if there are none.
pub(crate) fn unused(what: &str, names: &[&str], elsewhere: &[String]) -> Option<Finding> {
    let used = flags(elsewhere, names);
    let names: Vec<&str> = names.iter().zip(used).filter(|(_, used)| !used).map(|(name, _)| *name).collect();
    let what = || format!("{what} not used: {}", crate::rows::roles::shortened(&names));
    (!names.is_empty()).then(|| remark(what(), "--state with those that belong to the state, or --ignore"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_are_runs() {
        let records: Records = [2, 3, 4, 9, 10, 7].into_iter().collect();
        assert_eq!(records.runs.len(), 3);
        assert_eq!((0..6).map(|sample| records.at(sample)).collect::<Vec<_>>(), [2, 3, 4, 9, 10, 7]);
        let ends = |first, last| Some(RecordRange { word: "line", first, last });
        assert_eq!(records.ends("line"), ends(2, 7));
        assert_eq!([1, 3].into_iter().map(|sample| records.at(sample)).collect::<Records>().ends("line"), ends(3, 9));
        assert_eq!(Records::default().ends("line"), None);
    }

    #[test]
    fn a_clock_without_a_first_stamp_waits_for_one() {
        let mut clock = Clock::new(None);
        for stamp in [Stamp::MISSING, Stamp::whole(5000), Stamp::whole(6000)] {
            clock.push(stamp);
        }
        let seconds = clock.seconds(3, TimeUnit::Milliseconds);
        assert!(seconds[0].is_nan());
        assert_eq!(seconds[1..], [0.0, 1.0]);
    }
}
