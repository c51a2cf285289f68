//! The search for nearest samples: distances between trajectories, then all samples within a bandwidth's search radius.

mod block_search;
mod boxes;
mod closest;
mod distances;
mod minima;
pub(crate) mod nearest;
mod sample_tree;
mod space;
mod span;
mod tiles;
mod tree_search;

pub(crate) use nearest::NearestSamples;
pub(crate) use sample_tree::SampleTree;
pub(crate) use space::SearchSpace;
pub(crate) use span::check_span;
pub(crate) use tree_search::Neighbour;
