use std::io;
use std::path::Path;

use motion::{SampleIndex, Trajectory, upper_median};
use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use crate::{Decision, Learnt, LeftOut, Prepared, StateChannel, Trust, sha256_of_file};

/// The contents of a model file: the policy, its training data, all decisions and the verdict.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Model {
    /// The program that made the model, and the time.
    pub made_by: MadeBy,
    /// Dimensions of the state, (n).
    pub state: Vec<StateChannel>,
    /// Dimensions of the context, (p); empty if movements depend on the state alone.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub context: Vec<StateChannel>,
    /// The context fixed by [`Model::in_context`], (p) in the units of the recording; empty without one. It is not stored.
    #[serde(skip, default = "no_context")]
    pub chosen_context: DVector<f64>,
    /// Time step in seconds: the median over trajectories.
    pub time_step: f64,
    /// The training data.
    pub data: DataSummary,
    /// All automatic decisions, in order.
    pub decisions: Vec<Decision>,
    /// Random seed.
    pub seed: u64,
    /// How far the policy can be trusted.
    pub trust: Trust,
    /// The training rows, each predicted without its movement. They are not stored.
    #[serde(skip)]
    pub predicted: Vec<PredictedSpeed>,
    /// The policy, as a function of states and contexts multiplied by [`StateChannel::scale`].
    pub learnt: Learnt,
}

/// No context.
pub(crate) fn no_context() -> DVector<f64> {
    DVector::zeros(0)
}

/// Speed along a movement, as observed and as predicted by the Gaussian process from all other movements, in scaled units of the state
/// per second.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PredictedSpeed {
    /// Index of the sample; for a mean of samples, that of the first.
    pub index: SampleIndex,
    /// The observed speed, as used for learning.
    pub seen: f64,
    /// The predicted speed.
    pub predicted: f64,
}

/// The program that made a model, and when.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MadeBy {
    /// "policy-align 0.1.0".
    pub program: String,
    /// Coordinated universal time, ISO 8601; empty until the caller sets it.
    pub time: String,
}

/// Summary of a model's training data.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DataSummary {
    /// The files, in the given order.
    pub files: Vec<FileSummary>,
    /// Number of episodes in the training data.
    pub episodes: usize,
    /// Number of samples in the training data.
    pub samples: usize,
    /// Duration of the longest episode, in seconds.
    pub longest: f64,
    /// Median speed over all samples that were held in memory, in scaled units of the state per second; the reference for fast and slow.
    pub speed: f64,
    /// Episodes excluded from learning.
    pub left_out: Vec<LeftOut>,
}

impl DataSummary {
    /// The summary of these movements and their velocities, (n, N), without files.
    pub(crate) fn of(prepared: &Prepared, velocities: &DMatrix<f64>) -> DataSummary {
        let movements = prepared.demonstrations.trajectories();
        let seconds = movements.iter().map(Trajectory::duration);
        DataSummary {
            files: vec![],
            episodes: movements.len(),
            samples: prepared.demonstrations.n_samples(),
            longest: seconds.fold(0.0, f64::max),
            speed: upper_median(velocities.column_iter().map(|velocity| velocity.norm()).collect()).unwrap_or(0.0),
            left_out: prepared.left_out.clone(),
        }
    }

    /// The summary extended by further recordings, whose speeds are unknown.
    pub(crate) fn and(mut self, more: &DataSummary) -> DataSummary {
        self.files.extend(more.files.iter().cloned());
        self.left_out.extend(more.left_out.iter().cloned());
        self.episodes += more.episodes;
        self.samples += more.samples;
        self.longest = self.longest.max(more.longest);
        self
    }
}

impl MadeBy {
    /// This program, with the time not yet set.
    pub fn this() -> MadeBy {
        MadeBy { program: concat!("policy-align ", env!("CARGO_PKG_VERSION")).to_owned(), time: String::new() }
    }
}

impl Model {
    /// Names of the state's channels, (n).
    pub fn channels(&self) -> Vec<String> {
        StateChannel::names(&self.state)
    }

    /// Factors by which states of the recording are multiplied before the learner's policy is evaluated, (n).
    pub fn scales(&self) -> DVector<f64> {
        StateChannel::scales(&self.state)
    }

    /// Factor of the learner's potential: 1 / s² if all channels share the scale s, otherwise 1.
    pub(crate) fn potential_factor(&self) -> f64 {
        let scale = self.state[0].scale;
        if self.state.iter().all(|channel| channel.scale == scale) { scale.powi(-2) } else { 1.0 }
    }

    /// Factors for scaling recordings like the training data, in the form of [`PrepareOptions::scale`](crate::PrepareOptions::scale);
    /// channels without a factor are omitted.
    pub fn scale(&self) -> Vec<(String, f64)> {
        StateChannel::factors(self.inputs())
    }
}

/// A file, by its name without folders.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FileSummary {
    /// The name without folders, so that a model reveals nothing about its machine.
    pub name: String,
    /// SHA-256 of its bytes, hexadecimal.
    pub sha256: String,
    /// Its size in bytes.
    pub bytes: u64,
}

impl FileSummary {
    /// The summary of a file in its present state.
    ///
    /// # Errors
    /// The system's error.
    pub fn of(path: &Path) -> io::Result<FileSummary> {
        let (sha256, bytes) = sha256_of_file(path)?;
        let name =
            path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned());
        Ok(FileSummary { name, sha256, bytes })
    }
}
