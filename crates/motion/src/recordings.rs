use std::borrow::Cow;

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use crate::statistics::upper_median;
use crate::times::whole_step;
use crate::{Finding, Labels, MotionError, Times, Trajectory};

/// Recorded data: n channels of state, and episodes of any length.
///
/// In every episode, positions have n rows and one column per sample, stamps ascend, and numbers are finite. It may be too
/// short to be a movement; then `prepare` leaves it out and reports it.
#[derive(Debug, Clone, PartialEq)]
pub struct Recordings {
    /// Dimensions of the state, n of them.
    pub state: Vec<Channel>,
    /// One entry per movement, in the order of the file.
    pub episodes: Vec<Episode>,
    /// The reader's findings, none of which prevented reading.
    pub findings: Vec<Finding>,
}

/// Name and unit of one dimension of the state.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Channel {
    /// The name as in the file: `x`, `l_elbow`.
    pub name: String,
    /// The unit if the file or the user gives one: `m`, `rad`; a velocity has this unit per second.
    pub unit: Option<String>,
}

/// One recorded movement of N samples.
#[derive(Debug, Clone, PartialEq)]
pub struct Episode {
    /// The name as in the file: "3", "take 3", "demo_3".
    pub name: String,
    /// Its origin, for messages.
    pub source: Source,
    /// The time of each sample, (N); stamps ascend.
    pub times: Times,
    /// Positions, one column per sample, (n, N).
    pub positions: DMatrix<f64>,
    /// Velocities in units of the state per second, (n, N).
    pub velocities: Option<DMatrix<f64>>,
    /// Names of the constraints or tasks under which it was recorded.
    pub constraint: Option<Labels>,
    /// The context, which influences the movement and is constant during it, (p). Empty after reading, because preparation
    /// separates context from state.
    pub context: DVector<f64>,
}

/// The origin of an episode.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Source {
    /// Name of the file, without folders; empty if there is none.
    pub file: String,
    /// Position of its samples in the file; `None` if it is not meaningful.
    pub records: Option<RecordRange>,
}

/// The records of a file that hold an episode's samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RecordRange {
    /// The unit that is counted: "line", "row", "message", "sample".
    pub word: &'static str,
    /// The first sample's, counted from 1 as in the format.
    pub first: u64,
    /// The last sample's.
    pub last: u64,
}

/// Words in the names of context channels.
const CONTEXTS: [&str; 8] = ["goal", "target", "object", "obj", "load", "payload", "mass", "context"];

/// Whether a name is that of a context: goal, target, object, load and the like.
pub fn is_called_context(name: &str) -> bool {
    let name = name.to_lowercase();
    let is_word = |word: &str| CONTEXTS.contains(&word.trim_end_matches(|c: char| c.is_ascii_digit()));
    name.contains("environment_state") || name.split(|c: char| !c.is_alphanumeric()).any(is_word)
}

/// Borrows the recordings; they are cloned when needed.
impl<'a> From<&'a Recordings> for Cow<'a, Recordings> {
    fn from(recordings: &'a Recordings) -> Self {
        Cow::Borrowed(recordings)
    }
}

/// Takes ownership of the recordings.
impl From<Recordings> for Cow<'_, Recordings> {
    fn from(recordings: Recordings) -> Self {
        Cow::Owned(recordings)
    }
}

impl Recordings {
    /// The typical time between samples in seconds: the median over all episodes as a [`whole_step`]. A step that was given
    /// rather than measured (all stamps are multiples of it) is returned unchanged. 0 without a step.
    pub fn time_step(&self) -> f64 {
        let times = || self.episodes.iter().map(|episode| &episode.times);
        let mut given = times().filter(|times| times.len() > 1).map(given_step);
        if let Some(Some(first)) = given.next()
            && given.all(|step| step == Some(first))
        {
            return first;
        }
        let total: usize = times().map(|times| times.len().saturating_sub(1)).sum();
        let stride = total.div_ceil(MOST_STEPS).max(1);
        whole_step(upper_median(times().flat_map(Times::steps).step_by(stride).collect()).unwrap_or(0.0))
    }
}

/// The step if all stamps are multiples of it.
fn given_step(times: &Times) -> Option<f64> {
    let step = times.seconds(0, 1);
    (0..times.len()).all(|sample| times.seconds(0, sample) == sample as f64 * step).then_some(step)
}

/// Largest number of steps from which the median is computed.
const MOST_STEPS: usize = 1_000_000;

impl Episode {
    /// Number of samples N.
    pub fn n_samples(&self) -> usize {
        self.times.len()
    }

    /// x_{i+1} − x_i, (n).
    pub fn step(&self, sample: usize) -> DVector<f64> {
        self.positions.column(sample + 1) - self.positions.column(sample)
    }

    /// Samples `from` to `to`, excluding the last.
    #[must_use]
    pub fn part(&self, from: usize, to: usize) -> Episode {
        let at = |sample: usize| self.record(sample).map(|(_, record)| record);
        let whole = self.source.records.filter(|_| from < to);
        let records = whole.and_then(|whole| Some(RecordRange { first: at(from)?, last: at(to - 1)?, ..whole }));
        let source = Source { file: self.source.file.clone(), records };
        let constraint = self.constraint.as_ref().and_then(|labels| labels.chosen(from..to));
        let part = self.with(self.times.part(from..to), source, |values| values.columns(from, to - from).into_owned());
        Episode { constraint, ..part }
    }

    /// The same movement with `of` applied to positions and velocities.
    fn with(&self, times: Times, source: Source, of: impl Fn(&DMatrix<f64>) -> DMatrix<f64>) -> Episode {
        Episode {
            name: self.name.clone(),
            source,
            times,
            positions: of(&self.positions),
            velocities: self.velocities.as_ref().map(of),
            constraint: self.constraint.clone(),
            context: self.context.clone(),
        }
    }

    /// The episode as a movement for a learner.
    ///
    /// # Errors
    /// [`MotionError`] if it is not a valid [`Trajectory`].
    pub fn into_trajectory(self) -> Result<Trajectory, MotionError> {
        let trajectory = match self.times {
            Times::Even { step, .. } => Trajectory::new(self.positions, step)?,
            Times::Stamped(stamps) => Trajectory::stamped(stamps, self.positions)?,
        };
        let trajectory = trajectory.with_context(self.context)?.with_labels(self.constraint);
        match self.velocities {
            None => Ok(trajectory),
            Some(velocities) => trajectory.with_velocities(velocities),
        }
    }

    /// The place of a sample in its file: "demos.csv, line 17 (episode 1)".
    pub fn place(&self, sample: usize) -> String {
        let (name, file) = (&self.name, &self.source.file);
        match self.record(sample) {
            Some((word, record)) if word != "sample" => format!("{file}, {word} {record} (episode {name})"),
            _ if file.is_empty() => format!("episode {name}, sample {sample}"),
            _ => format!("{file}, episode {name}, sample {sample}"),
        }
    }

    /// The record of a sample with its unit, if records are consecutive.
    fn record(&self, sample: usize) -> Option<(&'static str, u64)> {
        let records = self.source.records?;
        (records.last.checked_sub(records.first)? + 1 == self.n_samples() as u64)
            .then(|| (records.word, records.first + sample as u64))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn step_of(stamps: &[f64]) -> f64 {
        let episode = Episode {
            name: String::new(),
            source: Source::default(),
            times: Times::Stamped(stamps.to_vec()),
            positions: DMatrix::zeros(1, stamps.len()),
            velocities: None,
            constraint: None,
            context: DVector::zeros(0),
        };
        Recordings { state: vec![], episodes: vec![episode], findings: vec![] }.time_step()
    }

    #[test]
    fn measured_steps_are_put_on_a_grid_and_given_ones_are_not() {
        let given = f64::from(0.05f32);
        let multiples: Vec<f64> = (0..20).map(|sample| f64::from(sample) * given).collect();
        assert_eq!(step_of(&multiples), given);
        let single_precision: Vec<f64> = (0..20u8).map(|sample| f64::from(f32::from(sample) / 50.0)).collect();
        assert_eq!(step_of(&single_precision), 0.02);
        assert_eq!(step_of(&[0.0, 0.017, 0.034, 0.05]), 0.017);
        assert_eq!(step_of(&[0.0, 0.0166, 0.03333, 0.05]), 1.0 / 60.0);
        assert_eq!(step_of(&[0.0, 0.3, 0.59, 0.89]), 0.3);
        assert_eq!(step_of(&[0.0]), 0.0);
    }
}
