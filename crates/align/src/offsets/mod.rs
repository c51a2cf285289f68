//! From nearest samples to offsets: responsibilities, the objective, its groups and its minimiser.

pub(crate) mod bipartition;
mod compensated;
mod eigen;
pub(crate) mod group_offsets;
mod laplacian;
mod linear_term;
mod objective;
pub(crate) mod responsibilities;
mod split;
mod two_means;
mod weights;

pub use objective::AlignmentObjective;
pub use split::{Split, SplitCause};
