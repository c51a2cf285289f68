use std::str::FromStr;

use serde::{Deserialize, Serialize};

use crate::StateChannel;

/// Options of preparation; by default everything is decided from the data.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct PrepareOptions {
    /// Channels that are scaled before learning: name and factor (`--scale z=10`).
    pub scale: Vec<(String, f64)>,
    /// Seconds between two samples; overrides the time stamps (`--dt`).
    pub time_step: Option<f64>,
    /// The use of recorded velocities (`--integration`).
    pub velocities: VelocityUse,
    /// How positions are smoothed (`--smooth`).
    pub smoothing: Smoothing,
    /// Whether episodes are cut where a single step is far too long (`--jumps`).
    pub jumps: Repair,
    /// Whether angles that jump by a whole turn are unwrapped, and quaternions that change sign have one (`--wraps`).
    pub wraps: Repair,
    /// Which channels are context (`--context`).
    pub context: ContextUse,
}

/// Which channels are context: what a movement depends on and what stays as it is meanwhile, such as a goal, the place of an
/// object, or a load. All others are state.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum ContextUse {
    /// Those that are constant in every episode, differ between episodes, and are called like one: goal, target, object, load.
    #[default]
    Auto,
    /// Those of these names, which must be constant in every episode.
    Named(Vec<String>),
    /// None.
    Ignored,
}

impl ContextUse {
    /// That of recordings with this context.
    pub fn of(channels: &[StateChannel]) -> ContextUse {
        match channels {
            [] => ContextUse::Ignored,
            channels => ContextUse::Named(channels.iter().map(|channel| channel.name.clone()).collect()),
        }
    }
}

/// The use of recorded velocities.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum VelocityUse {
    /// They are used if they agree with the steps.
    #[default]
    Auto,
    /// They are used where every episode has them; otherwise a finding says that they are not.
    Recorded,
    /// They are ignored.
    Ignored,
}

/// The treatment of apparent faults.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Repair {
    /// Repaired and reported.
    #[default]
    Auto,
    /// Left as they are: no faults.
    Keep,
}

/// How positions are smoothed before learning.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub enum Smoothing {
    /// According to their noise.
    #[default]
    Auto,
    /// Not at all; missing velocities are slopes between neighbours.
    Off,
    /// Savitzky–Golay of degree 2 over so many samples, an odd number from 5 on.
    Samples(usize),
    /// The same over about so many seconds.
    Seconds(f64),
}

/// "auto", "off", "9" (samples) or "0.2s"; the error of any other text is a sentence.
impl FromStr for Smoothing {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let seconds =
            text.strip_suffix('s').map(|number| number.trim().parse().ok().filter(|s: &f64| *s > 0.0 && s.is_finite()));
        let smoothing = match (text, seconds) {
            ("auto", _) => Some(Smoothing::Auto),
            ("off", _) => Some(Smoothing::Off),
            (_, Some(seconds)) => seconds.map(Smoothing::Seconds),
            (samples, None) => samples.parse().ok().map(Smoothing::Samples),
        };
        smoothing.ok_or_else(|| format!("'{text}' is not a window"))
    }
}
