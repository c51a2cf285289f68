//! From nearest samples to offsets: responsibilities, the objective, its groups and its minimiser.

pub(crate) mod bipartition;
pub(crate) mod compensated;
pub(crate) mod group_offsets;
pub(crate) mod laplacian;
pub(crate) mod linear_term;
mod objective;
pub(crate) mod responsibilities;
mod split;
pub(crate) mod two_means;
mod weights;

pub use objective::AlignmentObjective;
pub use split::{Split, SplitCause};
