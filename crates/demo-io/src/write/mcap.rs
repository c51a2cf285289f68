mod bag;
mod record;
mod topic;

use std::collections::BTreeMap;
use std::io::{self, Write};

use nalgebra::Isometry3;

use self::bag::Bag;
use self::topic::{JOINT_STATES, ROBOT_DESCRIPTION, TRANSFORMS};
use super::{Failure, LinkFrames, WriteError, has_velocities};

use crate::label_entry::LabelEntry;
use crate::rows::mcap::{EpisodeEntry, METADATA};
use crate::rows::packed::Writer;
use motion::Recordings;

/// Stamp of the first sample: 0 would mean that a driver did not set it.
const START: u64 = 1_000_000_000;

/// The last second that a ROS 2 stamp can hold, in nanoseconds.
const LATEST: u64 = i32::MAX as u64 * 1_000_000_000;

/// Nanoseconds between two movements without a message, so that programs can separate them.
const PAUSE: u64 = 5_000_000_000;

/// Writes one `sensor_msgs/msg/JointState` message per sample. A metadata record holds the names of movements and the units.
/// With a robot, also writes its URDF, once, and one `tf2_msgs/msg/TFMessage` message per sample with all its links.
pub(super) fn write(file: impl Write, recordings: &Recordings, robot: Option<&dyn LinkFrames>) -> Result<(), Failure> {
    has_velocities(recordings)?;
    let topics = [JOINT_STATES, ROBOT_DESCRIPTION, TRANSFORMS];
    let mut bag = Bag::create(file, if robot.is_some() { &topics } else { &topics[..1] })?;
    if let Some(robot) = robot {
        let mut description = Writer::default();
        description.text(robot.description());
        bag.message(1, START, &description.message())?;
    }
    let mut start = START;
    for episode in &recordings.episodes {
        let mut stamp = start;
        for (sample, time) in episode.times.stamps().iter().enumerate() {
            stamp = at(start, *time)
                .ok_or_else(|| WriteError::TooLong { episode: episode.name.clone(), seconds: *time })?;
            if let Some(robot) = robot {
                let transforms = robot.transforms(episode.positions.column(sample));
                let transforms = transforms.map_err(|reason| {
                    let place = format!("episode '{}', sample {sample}", episode.name);
                    WriteError::Robot { place, reason }
                })?;
                bag.message(2, stamp, &transform_message(robot, &transforms, stamp))?;
            }
            bag.message(0, stamp, &joint_message(recordings, episode, sample, stamp))?;
        }
        start = stamp + PAUSE;
    }
    bag.finish(METADATA, &metadata(recordings)?)?;
    Ok(())
}

/// The stamp `seconds` after another; `None` beyond the largest stamp of ROS 2, whose seconds are 32-bit integers.
fn at(start: u64, seconds: f64) -> Option<u64> {
    let stamp = start.checked_add((seconds * 1e9).round() as u64)?;
    (stamp <= LATEST).then_some(stamp)
}

fn joint_message(recordings: &Recordings, episode: &motion::Episode, sample: usize, stamp: u64) -> Vec<u8> {
    let mut writer = Writer::default();
    header(&mut writer, stamp, "");
    writer.u32(recordings.state.len() as u32);
    recordings.state.iter().for_each(|channel| writer.text(&channel.name));
    writer.numbers(episode.positions.column(sample).iter());
    match &episode.velocities {
        Some(velocities) => writer.numbers(velocities.column(sample).iter()),
        None => writer.numbers([].iter()),
    }
    writer.numbers([].iter());
    writer.message()
}

fn transform_message(robot: &dyn LinkFrames, transforms: &[Isometry3<f64>], stamp: u64) -> Vec<u8> {
    let mut writer = Writer::default();
    writer.u32(transforms.len() as u32);
    for ([parent, child], transform) in robot.links().iter().zip(transforms) {
        header(&mut writer, stamp, parent);
        writer.text(child);
        // nalgebra orders quaternions as i, j, k, w, like ROS.
        let numbers = transform.translation.vector.iter().chain(transform.rotation.coords.iter());
        numbers.for_each(|&number| writer.f64(number));
    }
    writer.message()
}

fn header(writer: &mut Writer, stamp: u64, frame: &str) {
    writer.i32((stamp / 1_000_000_000) as i32);
    writer.u32((stamp % 1_000_000_000) as u32);
    writer.text(frame);
}

fn metadata(recordings: &Recordings) -> io::Result<BTreeMap<String, String>> {
    let entries: Vec<EpisodeEntry> = recordings
        .episodes
        .iter()
        .map(|episode| EpisodeEntry {
            name: episode.name.clone(),
            messages: episode.times.len(),
            constraint: episode.constraint.as_ref().map(|labels| LabelEntry::of(labels, episode.times.len())),
        })
        .collect();
    let mut metadata = BTreeMap::from([("episodes".to_owned(), serde_json::to_string(&entries)?)]);
    for channel in &recordings.state {
        if let Some(unit) = &channel.unit {
            metadata.insert(format!("unit/{}", channel.name), unit.clone());
        }
    }
    Ok(metadata)
}
