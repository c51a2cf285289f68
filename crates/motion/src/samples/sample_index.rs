use serde::{Deserialize, Serialize};

/// Index of a sample in a trajectory, both counted from 0. Ordered by trajectory, then by sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct SampleIndex {
    /// Index of the trajectory.
    pub trajectory: usize,
    /// Index of the sample.
    pub sample: usize,
}
