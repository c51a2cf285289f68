use std::io;
use std::path::Path;

use motion::{SampleIndex, upper_median};
use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use crate::{Decision, Learnt, LeftOut, Prepared, StateChannel, Trust, sha256_of_file};

/// The contents of a model file: the policy, its training data, all decisions and the verdict.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Model {
    /// The program that made it, and when.
    pub made_by: MadeBy,
    /// Dimensions of the state, n of them.
    pub state: Vec<StateChannel>,
    /// Dimensions of the context, p of them; none where movements depend on the state alone.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub context: Vec<StateChannel>,
    /// The context that [`Model::in_context`] chose, (p) in the units of the recording, of no length without one. It is not stored.
    #[serde(skip, default = "nowhere")]
    pub chosen_context: DVector<f64>,
    /// Seconds; the median over trajectories.
    pub time_step: f64,
    /// The training data.
    pub data: DataSummary,
    /// All automatic decisions, in order.
    pub decisions: Vec<Decision>,
    /// Seed of every random choice.
    pub seed: u64,
    /// How far to trust it.
    pub trust: Trust,
    /// Rows learnt from, each predicted without its movement. They are not stored.
    #[serde(skip)]
    pub predicted: Vec<PredictedSpeed>,
    /// The policy, of states and contexts that were multiplied by [`StateChannel::scale`].
    pub learnt: Learnt,
}

/// No context.
pub(crate) fn nowhere() -> DVector<f64> {
    DVector::zeros(0)
}

/// Speed along a movement, as it was seen and as the Gaussian process predicts it from all other movements, in scaled units of the state
/// per second.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PredictedSpeed {
    /// Where it was seen; of a mean of samples the first of them.
    pub index: SampleIndex,
    /// As it was learnt from.
    pub seen: f64,
    /// As it is predicted.
    pub predicted: f64,
}

/// The program that made a model, and when.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MadeBy {
    /// "policy-align 0.1.0".
    pub program: String,
    /// Coordinated universal time, ISO 8601; empty until it is known.
    pub time: String,
}

/// Summary of a model's training data.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DataSummary {
    /// The files, in the order they were given.
    pub files: Vec<FileSummary>,
    /// Episodes learnt from.
    pub episodes: usize,
    /// Samples learnt from.
    pub samples: usize,
    /// Duration of the longest episode, in seconds.
    pub longest: f64,
    /// Median speed over all samples that were held at once, in scaled units of the state per second: what is fast and what is slow.
    pub speed: f64,
    /// Episodes not learnt from.
    pub left_out: Vec<LeftOut>,
}

impl DataSummary {
    /// Of these movements and their velocities, (n, N), without files.
    pub(crate) fn of(prepared: &Prepared, velocities: &DMatrix<f64>) -> DataSummary {
        let movements = prepared.demonstrations.trajectories();
        let seconds = movements.iter().map(|movement| movement.seconds(0, movement.n_samples() - 1));
        DataSummary {
            files: vec![],
            episodes: movements.len(),
            samples: prepared.demonstrations.n_samples(),
            longest: seconds.fold(0.0, f64::max),
            speed: upper_median(velocities.column_iter().map(|velocity| velocity.norm()).collect()).unwrap_or(0.0),
            left_out: prepared.left_out.clone(),
        }
    }

    /// Of further recordings as well, of whose speeds nothing is known.
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
    /// This program, at a time that is not known yet.
    pub fn this() -> MadeBy {
        MadeBy { program: concat!("policy-align ", env!("CARGO_PKG_VERSION")).to_owned(), time: String::new() }
    }
}

impl Model {
    /// Names of the state's channels, (n).
    pub fn channels(&self) -> Vec<String> {
        self.state.iter().map(|channel| channel.name.clone()).collect()
    }

    /// Factors by which states of the recording are multiplied before the learner's policy is evaluated, (n).
    pub fn scales(&self) -> DVector<f64> {
        DVector::from_iterator(self.state.len(), self.state.iter().map(|channel| channel.scale))
    }

    /// What the learner's potential is multiplied by: 1 / s² where all channels share the scale s, else 1.
    pub(crate) fn potential_factor(&self) -> f64 {
        let scale = self.state[0].scale;
        if self.state.iter().all(|channel| channel.scale == scale) { scale.powi(-2) } else { 1.0 }
    }

    /// Factors by which recordings are multiplied as those learnt from were, as
    /// [`PrepareOptions::scale`](crate::PrepareOptions::scale) takes them: of channels that have one.
    pub fn scale(&self) -> Vec<(String, f64)> {
        StateChannel::factors(self.inputs())
    }
}

/// A file, by its name without folders.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FileSummary {
    /// Without folders, so that a model reveals nothing of its machine.
    pub name: String,
    /// Of its bytes, hexadecimal.
    pub sha256: String,
    /// Its size.
    pub bytes: u64,
}

impl FileSummary {
    /// Of a file as it is now.
    ///
    /// # Errors
    /// What the system says.
    pub fn of(path: &Path) -> io::Result<FileSummary> {
        let (sha256, bytes) = sha256_of_file(path)?;
        let name =
            path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned());
        Ok(FileSummary { name, sha256, bytes })
    }
}
