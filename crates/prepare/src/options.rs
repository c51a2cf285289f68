use std::str::FromStr;

use serde::{Deserialize, Serialize};

use crate::StateChannel;

/// Options of preparation. By default all decisions follow from the data.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct PrepareOptions {
    /// Channels that are scaled before learning, as name and factor (`--scale z=10`).
    pub scale: Vec<(String, f64)>,
    /// Seconds between two samples; overrides the time stamps (`--dt`).
    pub time_step: Option<f64>,
    /// Whether the user gave the unit of the time stamps (`--time-unit`), so that velocities do not correct it.
    pub time_unit_given: bool,
    /// The use of recorded velocities (`--integration`).
    pub velocities: VelocityUse,
    /// Smoothing of positions (`--smooth`).
    pub smoothing: Smoothing,
    /// Whether single samples far from their neighbours are interpolated, and episodes cut at steps that are far too long (`--jumps`).
    pub jumps: Repair,
    /// Whether angles that jump by a whole turn are unwrapped, and quaternions that change sign get one sign (`--wraps`).
    pub wraps: Repair,
    /// Selection of the context channels (`--context`).
    pub context: ContextUse,
}

/// Selection of the context channels: quantities on which a movement depends and that are constant during it, such as a goal,
/// the place of an object, or a load. All others are state.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum ContextUse {
    /// Channels that are constant in every episode, differ between episodes, and have a typical name: goal, target, object,
    /// load.
    #[default]
    Auto,
    /// Channels with these names, which must be constant in every episode.
    Named(Vec<String>),
    /// None.
    Ignored,
}

impl ContextUse {
    /// The selection that was used for recordings with this context.
    pub fn of(channels: &[StateChannel]) -> ContextUse {
        match channels {
            [] => ContextUse::Ignored,
            channels => ContextUse::Named(StateChannel::names(channels)),
        }
    }
}

/// The use of recorded velocities.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum VelocityUse {
    /// Used if they agree with the steps and are not late.
    #[default]
    Auto,
    /// Used if every episode has them; otherwise a finding reports that they are not.
    Recorded,
    /// Ignored.
    Ignored,
}

/// The treatment of apparent faults.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Repair {
    /// Repair and report.
    #[default]
    Auto,
    /// Keep the data unchanged; they are not faults.
    Keep,
}

/// Smoothing of positions before learning.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub enum Smoothing {
    /// According to their noise.
    #[default]
    Auto,
    /// None; missing velocities are slopes between neighbours.
    Off,
    /// Savitzky–Golay of degree 2 over this number of samples, an odd number from 5 on.
    Samples(usize),
    /// The same over about this number of seconds.
    Seconds(f64),
}

/// "auto", "off", "9" (samples) or "0.2s"; for any other text the error is a sentence.
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
