use std::str::FromStr;

/// What a user may decide before learning; by default everything is decided from the data.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PrepareOptions {
    /// Channels whose unit is multiplied: name and factor (`--scale z=10`). The learner sees the state times these.
    pub scale: Vec<(String, f64)>,
    /// Seconds between two samples, whatever the stamps say (`--dt`).
    pub time_step: Option<f64>,
    /// What recorded velocities are used for (`--integration`).
    pub velocities: VelocityUse,
    /// How positions are smoothed (`--smooth`).
    pub smoothing: Smoothing,
    /// Whether episodes are cut where a single step is far too long (`--jumps`).
    pub jumps: Repair,
    /// Whether angles that jump by a whole turn go on instead (`--wraps`).
    pub wraps: Repair,
}

/// What recorded velocities are used for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum VelocityUse {
    /// They are believed if they agree with the steps.
    #[default]
    Auto,
    /// They are believed.
    Recorded,
    /// They are ignored.
    Ignored,
}

/// What is done with what looks like a fault.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Repair {
    /// It is repaired, and said.
    #[default]
    Auto,
    /// It is no fault.
    Keep,
}

/// How positions are smoothed before learning.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Smoothing {
    /// As their noise asks for.
    #[default]
    Auto,
    /// Not at all: where no velocities are known, they are slopes between neighbours.
    Off,
    /// Savitzky–Golay of degree 2 over so many samples, an odd number from 5 on.
    Samples(usize),
    /// The same over about so many seconds.
    Seconds(f64),
}

/// "auto", "off", "9" (samples) or "0.2s"; what is none of them is said in words.
impl FromStr for Smoothing {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let seconds = text.strip_suffix('s').map(|number| number.trim().parse().ok().filter(|s: &f64| *s > 0.0));
        let smoothing = match (text, seconds) {
            ("auto", _) => Some(Smoothing::Auto),
            ("off", _) => Some(Smoothing::Off),
            (_, Some(seconds)) => seconds.map(Smoothing::Seconds),
            (samples, None) => samples.parse().ok().map(Smoothing::Samples),
        };
        smoothing.ok_or_else(|| format!("'{text}' is no window"))
    }
}
