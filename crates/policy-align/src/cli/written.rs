//! Writes recordings and roll-outs as files, with the robot that moves.

use std::path::{Path, PathBuf};

use clap::Args;
use demo_io::WriteError;
use motion::Recordings;
use policy_align::RobotFrames;

use crate::cli::failure::{Exit, Failure, displayed};
use crate::cli::lines::Lines;
use crate::cli::options::values::urdf;

/// The robot beside the states, where recordings or roll-outs are written.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct RobotFlag {
    /// Robot with these joints: its links move in MCAP
    #[arg(long, value_name = "FILE.urdf")]
    robot: Option<PathBuf>,
}

impl RobotFlag {
    pub(crate) fn path(&self) -> Option<&Path> {
        self.robot.as_deref()
    }

    /// Writes recordings, and the robot if given; all channels except those of a context must be its joints. Returns which joints
    /// they are.
    pub(crate) fn write(
        &self,
        output: &Path,
        recordings: &Recordings,
        context: &[String],
    ) -> Result<Option<String>, Failure> {
        let Some(path) = &self.robot else {
            demo_io::write(output, recordings).map_err(|error| unwritten(output, error))?;
            return Ok(None);
        };
        let frames = RobotFrames::from_urdf(&urdf(path)?, &recordings.state, context).map_err(|reason| {
            Failure::usage(reason, displayed(path), "a URDF with a joint for each channel, by name or in their order")
        })?;
        demo_io::write_with_robot(output, recordings, &frames).map_err(|error| unwritten(output, error))?;
        Ok(Some(frames.matching()))
    }
}

impl Lines {
    /// Adds a line on the channels' joints if a robot was written.
    pub(crate) fn robot(&mut self, matching: Option<&str>) {
        if let Some(matching) = matching {
            self.add("robot", matching);
        }
    }
}

/// Converts the error of writing recordings.
fn unwritten(output: &Path, error: WriteError) -> Failure {
    let remedy = match error {
        WriteError::Io { source, .. } => return Failure::writing(output, source),
        WriteError::NoRobot { .. } => "-o with a name that ends in .mcap, or no --robot",
        WriteError::TooLong { .. } => "--time-unit, e.g. ns, or another format",
        WriteError::Robot { .. } => "other --units, or no --robot",
        _ => "another format",
    };
    Failure::of_text(Exit::Usage, &error.to_string(), displayed(output), remedy)
}
