//! Recordings to files.

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

/// Why nothing was written.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum WriteError {
    /// The extension names no format that is written.
    #[error("files ending in '.{extension}' are not written; use one of: csv, tsv, npz, jsonl, mcap")]
    Extension {
        /// Without its point.
        extension: String,
    },
    /// The format needs a feature that was not built in.
    #[error("'.{extension}' needs demo-io's feature '{feature}', which was not built in")]
    Feature {
        /// Without its point.
        extension: String,
        /// To be turned on.
        feature: &'static str,
    },
    /// The system does not let us write.
    #[error("{} cannot be written: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// A reader would take a channel for something else.
    #[error("with these names a reader would take {found} for the state; write .jsonl or .npz, or rename the channels")]
    Names {
        /// What would be read as state.
        found: String,
    },
    /// Velocities in some episodes only.
    #[error(
        "episode {episode} has no velocities but others have; this format has columns for all or none, .jsonl has not"
    )]
    SomeVelocities {
        /// The first without.
        episode: String,
    },
    /// Only MCAP holds a robot.
    #[error("files ending in '.{extension}' hold no robot; write .mcap")]
    NoRobot {
        /// Without its point.
        extension: String,
    },
    /// A robot cannot be where a sample is.
    #[error("the robot cannot be where {place} is: {reason}")]
    Robot {
        /// Episode and sample.
        place: String,
        /// What the robot says.
        reason: String,
    },
    /// Stamps of ROS 2 end after 68 years.
    #[error(
        "a sample of episode {episode} is {seconds} s after the first, and the stamps of the whole file end before 68 years"
    )]
    TooLong {
        /// In which it is.
        episode: String,
        /// After the first sample of its episode.
        seconds: f64,
    },
    /// There is no episode or no channel.
    #[error("there is nothing to write: {episodes} episodes of {channels} channels")]
    Nothing {
        /// How many.
        episodes: usize,
        /// How many.
        channels: usize,
    },
}

/// Writes recordings in the format of the extension: csv, tsv, npz, jsonl, and with the feature `mcap` mcap.
///
/// The file appears whole or not at all: a temporary file in the same folder is renamed.
///
/// # Errors
///
/// [`WriteError`]: an unknown extension, names that would be misread, or what the system refuses.
pub fn write(path: &Path, recordings: &Recordings) -> Result<(), WriteError> {
    write_any(path, recordings, None)
}

/// [`write()`] to MCAP with the robot that moves: topics `/robot_description`, its URDF as `std_msgs/msg/String`, and `/tf`, where
/// its links are at every sample as `tf2_msgs/msg/TFMessage`, beside `/joint_states`.
///
/// # Errors
///
/// [`WriteError`]: another format than MCAP, a state in which the robot cannot be, or what [`write()`] refuses.
pub fn write_with_robot(path: &Path, recordings: &Recordings, robot: &dyn LinkFrames) -> Result<(), WriteError> {
    write_any(path, recordings, Some(robot))
}

/// A robot as viewers draw it: its description, and the frames of its links in a state.
pub trait LinkFrames {
    /// The text of its URDF.
    fn description(&self) -> &str;

    /// Names of parent and child of every link but the root.
    fn links(&self) -> &[[String; 2]];

    /// In a state (n), the pose of each of [`LinkFrames::links`] in its parent's frame, metres, in their order.
    ///
    /// # Errors
    /// In a sentence, why the robot cannot be in this state.
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

/// What goes wrong while bytes are made.
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
