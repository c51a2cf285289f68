//! Samples of movements: which one, which of them, and under which constraint.

mod labels;
mod sample_index;
mod sample_set;

pub use labels::Labels;
pub use sample_index::SampleIndex;
pub use sample_set::SampleSet;
