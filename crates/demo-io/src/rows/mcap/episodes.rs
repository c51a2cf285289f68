//! Episodes of a bag, from its metadata.

use std::collections::BTreeMap;

use crate::label_entry::LabelEntry;
use crate::raw::RawEpisode;

/// The episodes that [`crate::write`] listed in the metadata; without them, all messages are one episode.
pub(super) fn episodes(raw: RawEpisode, metadata: &BTreeMap<String, String>) -> Vec<RawEpisode> {
    let listed = metadata.get("episodes").and_then(|text| serde_json::from_str::<Vec<EpisodeEntry>>(text).ok());
    let listed = listed.unwrap_or_default();
    let total: usize = listed.iter().fold(0, |total, episode| total.saturating_add(episode.messages));
    if total != raw.len() {
        return vec![raw];
    }
    let mut start = 0;
    let cut = listed.into_iter().map(|episode| {
        let samples = start..start + episode.messages;
        start = samples.end;
        let constraint = episode.constraint.and_then(|entry| entry.labels(samples.len()));
        RawEpisode { name: episode.name, constraint, ..raw.chosen(samples) }
    });
    cut.collect()
}

/// The metadata of an episode.
#[derive(Debug, serde::Serialize, serde::Deserialize)]
pub(crate) struct EpisodeEntry {
    pub(crate) name: String,
    pub(crate) messages: usize,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) constraint: Option<LabelEntry>,
}
