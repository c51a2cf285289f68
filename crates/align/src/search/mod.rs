//! The search for nearest samples: distances between trajectories, then whatever is within a bandwidth's search radius.

mod block_search;
mod boxes;
mod closest;
mod distances;
mod minima;
pub(crate) mod nearest;
mod space;
mod tiles;

pub(crate) use nearest::NearestSamples;
pub(crate) use space::SearchSpace;
