use serde::{Deserialize, Serialize};

/// Where velocities come from, for the learners.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum VelocitySource {
    /// Exact velocities as recorded, with exact positions.
    Recorded,
    /// Exact velocities as recorded; noisy positions, which are fused with them.
    Fused,
    /// Velocities with noise of this variance along each axis.
    Noisy(f64),
    /// Positions alone.
    Positions,
    /// Positions alone, taken as they stand: smoothed as the user said, or not at all.
    PositionsAsRequested,
}
