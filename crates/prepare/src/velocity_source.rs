use serde::{Deserialize, Serialize};

/// Source of the velocities, for the learners.
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
    /// Positions alone, used as they are: smoothed as the user requested, or not at all.
    PositionsAsRequested,
}
