use serde::{Deserialize, Serialize};

/// Which sample of which trajectory, both counted from 0. Ordered by trajectory, then by sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct SampleIndex {
    /// The trajectory.
    pub trajectory: usize,
    /// Its sample.
    pub sample: usize,
}
