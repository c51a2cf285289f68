use serde::{Deserialize, Serialize};

/// An episode that was not used.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LeftOutEpisode {
    /// Its name.
    pub episode: String,
    /// "not connected".
    pub why: String,
}
