use gp::Acting;
use prepare::numbers::short;
use serde::{Deserialize, Serialize};

use crate::StateChannel;
use prepare::sum_of_parts;

/// Degrees below which the uncertainty of a normal does not matter.
const LEAST_ANGLE: f64 = 0.01;

/// The quantity that a constraint acts on.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ConstraintOn {
    /// The recorded channels.
    Channels,
    /// The position of a link's origin, metres in the root link's frame.
    Position(String),
    /// The orientation of a link, in the root link's axes.
    Orientation(String),
}

/// A stretch of an episode, and the constraint A v = b estimated on it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ConstraintStretch {
    /// Name of the episode.
    pub episode: String,
    /// First and last sample of the recording.
    pub samples: (usize, usize),
    /// Times of the first and the last sample, in seconds from the beginning of the episode.
    pub seconds: (f64, f64),
    /// The recording's label of the constraint, if there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub label: Option<String>,
    /// The constraint, or its absence, on the stretch.
    pub acting: Acting,
    /// The quantity whose velocity is v.
    pub on: ConstraintOn,
    /// Rows of A, each of unit length with a positive largest entry: (k, n) in units of the recording, or (k, 3). Empty
    /// without a constraint.
    pub normals: Vec<Vec<f64>>,
    /// b, (k): velocity along each row; exactly 0 if indistinguishable from 0.
    pub speeds: Vec<f64>,
    /// The constant value along each row, (k), in the unit of the row; `None` for an orientation, or if b is not 0.
    pub levels: Vec<Option<f64>>,
    /// Expected angle between these rows and the true ones, in degrees.
    pub angle: f64,
    /// Logarithm of the likelihood ratio of this constraint to no constraint.
    pub evidence: f64,
    /// Directions in the channels along which a further constraint would not be detected.
    pub hidden: Vec<Vec<f64>>,
}

impl ConstraintStretch {
    /// Description: "z = 0.42 m", "gripper: 0.71 x + 0.71 y = 0.2 m", "no constraint".
    pub fn in_words(&self, state: &[StateChannel]) -> String {
        match self.acting {
            Acting::Constraint => self.constraint_in_words(state),
            Acting::Changing => "a constraint whose normal changes during the stretch".to_owned(),
            Acting::Nothing => "no constraint seen".to_owned(),
            Acting::Unseen => "not observable: the policy's action is within its uncertainty here".to_owned(),
        }
    }

    /// The expected error of the normals: "± 0.3°".
    pub fn angle_in_words(&self) -> String {
        if self.angle < LEAST_ANGLE { format!("± < {LEAST_ANGLE}°") } else { format!("± {}°", short(self.angle)) }
    }

    fn constraint_in_words(&self, state: &[StateChannel]) -> String {
        let (names, units): (Vec<&str>, Vec<Option<&str>>) = match self.on {
            ConstraintOn::Channels => {
                state.iter().map(|channel| (channel.name.as_str(), channel.unit.as_deref())).unzip()
            }
            ConstraintOn::Position(_) => ["x", "y", "z"].map(|name| (name, Some("m"))).into_iter().unzip(),
            ConstraintOn::Orientation(_) => ["x", "y", "z"].map(|name| (name, Some("rad"))).into_iter().unzip(),
        };
        let row = |at: usize| {
            let normal = &self.normals[at];
            let unit = unit_of(normal, &units);
            let direction = sum_of_parts(normal, &names, 2);
            match (&self.on, self.levels[at]) {
                (_, Some(level)) => format!("{direction} = {}{unit}", short(level)),
                (ConstraintOn::Orientation(_), None) if self.speeds[at] == 0.0 => {
                    format!("does not turn about {direction}")
                }
                (_, None) => format!("{direction} moves at {}{unit}/s", short(self.speeds[at])),
            }
        };
        let rows: Vec<String> = (0..self.normals.len()).map(row).collect();
        match &self.on {
            ConstraintOn::Channels => rows.join(", "),
            ConstraintOn::Position(link) | ConstraintOn::Orientation(link) => format!("{link}: {}", rows.join(", ")),
        }
    }
}

/// The unit, such as " m", if all channels with non-negligible weight share it.
fn unit_of(normal: &[f64], units: &[Option<&str>]) -> String {
    let mut own = normal.iter().zip(units).filter(|(part, _)| part.abs() >= 0.01).map(|(_, unit)| *unit);
    let first = own.next().flatten();
    match first {
        Some(unit) if own.all(|other| other == Some(unit)) => format!(" {unit}"),
        _ => String::new(),
    }
}
