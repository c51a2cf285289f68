//! Names of constraints as JSON.

use motion::Labels;
use serde::{Deserialize, Serialize};

/// One name for a whole episode, or one for each of its samples.
#[derive(Debug, Serialize, Deserialize)]
#[serde(untagged)]
pub(crate) enum LabelEntry {
    One(String),
    Each(Vec<String>),
}

impl LabelEntry {
    /// The entry of an episode of `samples` samples.
    pub(crate) fn of(labels: &Labels, samples: usize) -> Self {
        match labels.only() {
            Some(name) => LabelEntry::One(name.to_owned()),
            None => LabelEntry::Each((0..samples).map(|sample| labels.at(sample).to_owned()).collect()),
        }
    }

    /// `None` without a name, or if the number of names differs from the number of samples.
    #[cfg(feature = "mcap")]
    pub(crate) fn labels(self, samples: usize) -> Option<Labels> {
        match self {
            LabelEntry::One(name) => Some(Labels::from(name)).filter(|labels| !labels.is_blank()),
            LabelEntry::Each(names) => (names.len() == samples).then(|| Labels::of_samples(names)).flatten(),
        }
    }
}
