//! A robot for forward kinematics: links in one array, parents first, each moved by its joint.

mod coupling;
mod node;
mod placement;

pub(crate) use coupling::Coupling;
pub(crate) use node::{Motion, Node, Position};
pub(crate) use placement::{Padded, Placement, PlacementGroup, cross, padded};
