//! Writes recordings to files.

mod delimited;
mod json_lines;
#[cfg(feature = "mcap")]
mod mcap;
mod npz;

use std::io;
use std::path::{Path, PathBuf};

use nalgebra::{DVectorView, Isometry3};
use thiserror::Error;

use crate::whole_file::{Sink, write_whole};
use motion::Recordings;

/// Reasons why nothing was written.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum WriteError {
    /// No format for writing has this extension.
    #[error("files ending in '.{extension}' are not written; use one of: csv, tsv, npz, jsonl, mcap")]
    Extension {
        /// Extension without its dot.
        extension: String,
    },
    /// The format needs a feature that was not compiled in.
    #[error("'.{extension}' needs demo-io's feature '{feature}', which was not built in")]
    Feature {
        /// Extension without its dot.
        extension: String,
        /// Feature to enable.
        feature: &'static str,
    },
    /// The operating system does not allow writing.
    #[error("{} cannot be written: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// A reader would assign another role to a channel.
    #[error("with these names a reader would take {found} for the state; write .jsonl or .npz, or rename the channels")]
    Names {
        /// The columns that would be read as state.
        found: String,
    },
    /// Only some episodes have velocities.
    #[error(
        "episode {episode} has no velocities but others have; this format has columns for all or none, .jsonl has not"
    )]
    SomeVelocities {
        /// The first episode without velocities.
        episode: String,
    },
    /// Only MCAP can hold a robot.
    #[error("files ending in '.{extension}' hold no robot; write .mcap")]
    NoRobot {
        /// Extension without its dot.
        extension: String,
    },
    /// The robot cannot take the state of a sample.
    #[error("the robot cannot be where {place} is: {reason}")]
    Robot {
        /// Episode and sample.
        place: String,
        /// The robot's explanation.
        reason: String,
    },
    /// The stamps of ROS 2 end after 68 years.
    #[error(
        "a sample of episode {episode} is {seconds} s after the first, and the stamps of the whole file end before 68 years"
    )]
    TooLong {
        /// The episode of the sample.
        episode: String,
        /// Seconds after the first sample of the episode.
        seconds: f64,
    },
    /// There is no episode or no channel.
    #[error("there is nothing to write: {episodes} episodes of {channels} channels")]
    Nothing {
        /// Number of episodes.
        episodes: usize,
        /// Number of channels.
        channels: usize,
    },
}

/// Writes recordings in the format of the extension: csv, tsv, npz, jsonl, and mcap with the feature `mcap`.
///
/// The file appears completely or not at all: a temporary file in the same folder is renamed.
///
/// # Errors
///
/// [`WriteError`]: an unknown extension, names that would be misread, or an error of the operating system.
pub fn write(path: &Path, recordings: &Recordings) -> Result<(), WriteError> {
    write_any(path, recordings, None)
}

/// As [`write()`] to MCAP, with the moving robot: beside `/joint_states`, the topics `/robot_description`, its URDF as
/// `std_msgs/msg/String`, and `/tf`, the frames of its links at every sample as `tf2_msgs/msg/TFMessage`.
///
/// # Errors
///
/// [`WriteError`]: a format other than MCAP, a state that the robot cannot take, or an error of [`write()`].
pub fn write_with_robot(path: &Path, recordings: &Recordings, robot: &dyn LinkFrames) -> Result<(), WriteError> {
    write_any(path, recordings, Some(robot))
}

/// A robot for viewers: its description, and the frames of its links in a state.
pub trait LinkFrames {
    /// The text of its URDF.
    fn description(&self) -> &str;

    /// Names of parent and child for every link except the root.
    fn links(&self) -> &[[String; 2]];

    /// In a state (n), the pose of each of [`LinkFrames::links`], in their order, in its parent's frame, in metres.
    ///
    /// # Errors
    /// A sentence that explains why the robot cannot take this state.
    fn transforms(&self, state: DVectorView<'_, f64>) -> Result<Vec<Isometry3<f64>>, String>;
}

fn write_any(path: &Path, recordings: &Recordings, robot: Option<&dyn LinkFrames>) -> Result<(), WriteError> {
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    if robot.is_some() && extension != "mcap" {
        return Err(WriteError::NoRobot { extension });
    }
    if recordings.episodes.is_empty() || recordings.state.is_empty() {
        return Err(WriteError::Nothing { episodes: recordings.episodes.len(), channels: recordings.state.len() });
    }
    match &extension[..] {
        "csv" => whole(path, |file| delimited::write(file, recordings, b',')),
        "tsv" => whole(path, |file| delimited::write(file, recordings, b'\t')),
        "jsonl" | "ndjson" => whole(path, |file| json_lines::write(file, recordings)),
        "npz" => whole(path, |file| npz::write(file, recordings)),
        #[cfg(feature = "mcap")]
        "mcap" => whole(path, |file| mcap::write(file, recordings, robot)),
        #[cfg(not(feature = "mcap"))]
        "mcap" => Err(WriteError::Feature { extension, feature: "mcap" }),
        _ => Err(WriteError::Extension { extension }),
    }
}

/// Errors while bytes are generated.
#[derive(Debug, Error)]
enum Failure {
    #[error(transparent)]
    Io(#[from] io::Error),
    #[error(transparent)]
    Write(#[from] WriteError),
}

fn whole(path: &Path, fill: impl FnOnce(&mut dyn Sink) -> Result<(), Failure>) -> Result<(), WriteError> {
    write_whole(path, fill).map_err(|failure| match failure {
        Failure::Io(source) => WriteError::Io { path: path.to_owned(), source },
        Failure::Write(error) => error,
    })
}

/// Whether all episodes have velocities; an error if only some have.
fn has_velocities(recordings: &Recordings) -> Result<bool, WriteError> {
    let with = recordings.episodes.iter().filter(|episode| episode.velocities.is_some()).count();
    match recordings.episodes.iter().find(|episode| episode.velocities.is_none()) {
        Some(episode) if with > 0 => Err(WriteError::SomeVelocities { episode: episode.name.clone() }),
        without => Ok(without.is_none()),
    }
}

#[cfg(test)]
mod tests;
