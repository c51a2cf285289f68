//! Episodes that are noted beside the messages.

use std::collections::BTreeMap;

use crate::raw::RawEpisode;

/// The episodes that [`crate::write`] noted beside the messages; otherwise all is one.
pub(super) fn episodes(draft: RawEpisode, metadata: &BTreeMap<String, String>) -> Vec<RawEpisode> {
    let noted =
        metadata.get("episodes").and_then(|text| serde_json::from_str::<Vec<Noted>>(text).ok()).unwrap_or_default();
    let total: usize = noted.iter().fold(0, |total, episode| total.saturating_add(episode.messages));
    if total != draft.len() {
        return vec![draft];
    }
    let mut start = 0;
    let cut = noted.into_iter().map(|episode| {
        let samples = start..start + episode.messages;
        start = samples.end;
        RawEpisode { name: episode.name, constraint: episode.constraint, ..draft.chosen(samples) }
    });
    cut.collect()
}

/// An episode beside the messages.
#[derive(Debug, serde::Serialize, serde::Deserialize)]
pub(crate) struct Noted {
    pub(crate) name: String,
    pub(crate) messages: usize,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) constraint: Option<String>,
}
