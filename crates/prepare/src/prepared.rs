use motion::{Decision, Demonstrations, Finding, LeftOut};

use crate::options::Smoothing;
use crate::samples::noise::Noise;
use crate::{StateChannel, VelocitySource};

/// Demonstrations ready for learning, with all decisions and findings.
#[derive(Debug, Clone, PartialEq)]
pub struct Prepared {
    /// Movements, states and velocities times the channels' scales.
    pub demonstrations: Demonstrations,
    /// Name of each movement, (K).
    pub episodes: Vec<String>,
    /// Label of the constraint of each movement, (K), where the file has one.
    pub constraints: Vec<Option<String>>,
    /// Dimensions of the state, n of them.
    pub state: Vec<StateChannel>,
    /// Median time step in seconds.
    pub time_step: f64,
    /// Noise of positions and velocities.
    pub noise: Noise,
    /// Where velocities come from.
    pub velocities: VelocitySource,
    /// Requested smoothing, already applied to the demonstrations unless it is automatic.
    pub smoothing: Smoothing,
    /// Number of consecutive samples averaged to one before learning; 1: none.
    pub averaged: usize,
    /// All automatic decisions, in order.
    pub decisions: Vec<Decision>,
    /// Reasons to doubt the data.
    pub findings: Vec<Finding>,
    /// Episodes that are not used.
    pub left_out: Vec<LeftOut>,
}
