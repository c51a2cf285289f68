use motion::{Channel, Demonstrations};
use serde::{Deserialize, Serialize};

use crate::AlignError;

/// Summary of a policy's training data, stored with the policy. It has no effect on predictions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Origin {
    /// Seconds between two samples, as the median over the trajectories.
    pub time_step: f64,
    /// Number of trajectories.
    pub n_trajectories: usize,
    /// The trajectories that were learnt from, ascending; `None` if all were.
    pub kept: Option<Vec<usize>>,
    /// Warnings, one sentence each.
    pub warnings: Vec<String>,
    /// Name and unit of each dimension of the state, n of them; empty if none were given.
    #[serde(rename = "labels")]
    pub channels: Vec<Channel>,
}

impl Origin {
    pub(crate) fn new(demonstrations: &Demonstrations) -> Self {
        Origin {
            time_step: demonstrations.time_step(),
            n_trajectories: demonstrations.n_trajectories(),
            kept: None,
            warnings: Vec::new(),
            channels: Vec::new(),
        }
    }

    /// With names and units for the `dim` dimensions, or none.
    pub(crate) fn with_channels(self, channels: Vec<Channel>, dim: usize) -> Result<Self, AlignError> {
        if channels.is_empty() || channels.len() == dim {
            return Ok(Origin { channels, ..self });
        }
        Err(AlignError::Channels { found: channels.len(), expected: dim })
    }

    /// Checks the summary for a policy with `dim` dimensions; the error describes the fault.
    pub(crate) fn check(&self, dim: usize) -> Result<(), &'static str> {
        let kept = self.kept.as_deref();
        let ascending = |kept: &[usize]| {
            kept.is_sorted_by(|a, b| a < b) && kept.last().is_some_and(|&last| last < self.n_trajectories)
        };
        let checks = [
            (self.time_step > 0.0 && self.time_step.is_finite(), "the time step is not positive and finite"),
            (self.n_trajectories > 0, "it was learnt from no trajectory"),
            (kept.is_none_or(ascending), "the kept trajectories are not ascending numbers of those seen"),
            (
                self.channels.is_empty() || self.channels.len() == dim,
                "the number of labels is not that of the dimensions",
            ),
        ];
        checks.into_iter().find(|(fine, _)| !fine).map_or(Ok(()), |(_, reason)| Err(reason))
    }
}
