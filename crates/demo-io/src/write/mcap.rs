mod bag;
mod record;

use std::collections::BTreeMap;
use std::io::{self, Write};

use self::bag::Bag;
use super::{Failure, has_velocities};

use crate::label_entry::LabelEntry;
use crate::rows::mcap::{EpisodeEntry, METADATA};
use crate::rows::packed::Writer;
use motion::Recordings;

/// Stamp of the first sample: 0 would mean that a driver left it out.
const START: u64 = 1_000_000_000;

/// Nanoseconds without a message between two movements, so that programs see them apart.
const PAUSE: u64 = 5_000_000_000;

/// Messages of `sensor_msgs/msg/JointState`, a message a sample; names of movements and units stand in a metadata record.
pub(super) fn write(file: impl Write, recordings: &Recordings) -> Result<(), Failure> {
    has_velocities(recordings)?;
    let mut bag = Bag::create(file)?;
    let mut start = START;
    for episode in &recordings.episodes {
        let mut stamp = start;
        for (sample, time) in episode.times.stamps().iter().enumerate() {
            stamp = start + (time * 1e9).round() as u64;
            bag.message(stamp, &message(recordings, episode, sample, stamp))?;
        }
        start = stamp + PAUSE;
    }
    bag.finish(METADATA, &metadata(recordings)?)?;
    Ok(())
}

fn message(recordings: &Recordings, episode: &motion::Episode, sample: usize, stamp: u64) -> Vec<u8> {
    let mut writer = Writer::default();
    writer.i32((stamp / 1_000_000_000) as i32);
    writer.u32((stamp % 1_000_000_000) as u32);
    writer.text("");
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
