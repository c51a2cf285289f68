use std::path::PathBuf;

use clap::Args;
use policy_align::{ConstraintSet, JointLimits, Model, RollOut};
use serde::{Deserialize, Serialize};

use crate::cli::failure::{Failure, displayed};
use crate::cli::options::values::urdf;

/// How a policy is followed: table `[rollout]`.
#[derive(Debug, Clone, Default, PartialEq, Args, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[command(next_help_heading = "Roll-out")]
pub(crate) struct RollOutFlags {
    /// Constraints of the roll-out
    #[arg(long, value_name = "FILE.toml")]
    constraint: Option<PathBuf>,
    /// Longest duration [default: 3 times the longest episode]
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    seconds: Option<f64>,
    /// Time between samples [default: the model's time step]
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    step: Option<f64>,
    /// Robot whose joint limits stop the roll-out
    #[arg(long, value_name = "FILE.urdf")]
    limits: Option<PathBuf>,
}

impl RollOutFlags {
    pub(crate) fn roll_out(&self, model: &Model) -> Result<RollOut, Failure> {
        let channels = model.channels();
        let constraints = match &self.constraint {
            None => ConstraintSet::default(),
            Some(path) => ConstraintSet::load(path, &channels).map_err(|error| Failure::constraints(path, &error))?,
        };
        let limits = match &self.limits {
            None => None,
            Some(path) => {
                let limits = JointLimits::from_urdf(&urdf(path)?, &channels);
                Some(limits.map_err(|reason| {
                    Failure::usage(reason, displayed(path), "a URDF with joints named like the channels")
                })?)
            }
        };
        Ok(RollOut { constraints, limits, seconds: self.seconds, step: self.step })
    }
}
