use std::f64::consts::TAU;

use nalgebra::DVector;
use serde::{Deserialize, Serialize};

/// A dimension of the state or of the context, in the user's units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StateChannel {
    /// Name in the recording.
    pub name: String,
    /// Unit, if the recording or the user states it.
    pub unit: Option<String>,
    /// Factor that is applied to the channel before learning.
    pub scale: f64,
    /// Smallest value in the training data.
    pub low: f64,
    /// Largest value in the training data.
    pub high: f64,
    /// Median of the training data.
    pub median: f64,
}

impl StateChannel {
    /// The largest distance from 0 in turns, if the channel is an angle in radians.
    pub fn turns(&self) -> f64 {
        self.low.abs().max(self.high.abs()) / TAU
    }

    /// Names of the channels.
    pub fn names<'a>(channels: impl IntoIterator<Item = &'a StateChannel>) -> Vec<String> {
        channels.into_iter().map(|channel| channel.name.clone()).collect()
    }

    /// Scales of the channels.
    pub fn scales<'a>(channels: impl IntoIterator<Item = &'a StateChannel>) -> DVector<f64> {
        DVector::from_vec(channels.into_iter().map(|channel| channel.scale).collect())
    }

    /// Factors of the channels that have one, in the form of [`PrepareOptions::scale`](crate::PrepareOptions::scale).
    pub fn factors<'a>(channels: impl IntoIterator<Item = &'a StateChannel>) -> Vec<(String, f64)> {
        let scaled = channels.into_iter().filter(|channel| channel.scale != 1.0);
        scaled.map(|channel| (channel.name.clone(), channel.scale)).collect()
    }
}
