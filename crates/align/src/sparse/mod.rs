//! The alignment of many trajectories, each of which meets few others: the same offsets without the matrix H.

mod clusters;
mod conjugate_gradients;
mod forest;
mod group;
mod hash;
mod offsets;
mod partition;
mod preconditioner;
mod shared_samples;
mod sparsifier;
mod weak_modes;

pub(crate) use offsets::offsets;
pub(crate) use partition::partition;
pub(crate) use shared_samples::SharedSamples;
