//! Samples of movements: indices, sets, and labels of constraints.

mod labels;
mod sample_index;
mod sample_set;

pub use labels::Labels;
pub use sample_index::SampleIndex;
pub use sample_set::SampleSet;
