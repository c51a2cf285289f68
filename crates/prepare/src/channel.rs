use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

/// A dimension of the state or of the context, in the user's units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StateChannel {
    /// As in the recording.
    pub name: String,
    /// If the recording or the user names it.
    pub unit: Option<String>,
    /// Factor on the channel before learning.
    pub scale: f64,
    /// Least value learnt from.
    pub low: f64,
    /// Largest value learnt from.
    pub high: f64,
    /// Median of the values learnt from.
    pub median: f64,
}

impl StateChannel {
    /// The largest distance from 0 in turns, if it is an angle in radians.
    pub fn turns(&self) -> f64 {
        self.low.abs().max(self.high.abs()) / TAU
    }

    /// Factors of those of these channels that have one, as [`PrepareOptions::scale`](crate::PrepareOptions::scale) takes them.
    pub fn factors<'a>(channels: impl IntoIterator<Item = &'a StateChannel>) -> Vec<(String, f64)> {
        let scaled = channels.into_iter().filter(|channel| channel.scale != 1.0);
        scaled.map(|channel| (channel.name.clone(), channel.scale)).collect()
    }
}
