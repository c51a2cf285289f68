//! Repairs of faulty recordings.

pub(crate) mod displacements;
pub(crate) mod duplicates;
pub(crate) mod episodes;
pub(crate) mod glitches;
pub(crate) mod jumps;
pub(crate) mod labels;
pub(crate) mod lag;
pub(crate) mod quaternions;
pub(crate) mod stamps;
pub(crate) mod velocities;
pub(crate) mod velocity_offset;
pub(crate) mod velocity_origin;
pub(crate) mod wraps;
