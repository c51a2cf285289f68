//! All integration tests in one program, so that shared code is compiled once and the tests run in parallel.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod attachment;
mod batch;
#[cfg(feature = "collision")]
mod collision_shapes;
mod conformance;
mod mass_matrix;
#[cfg(feature = "collision")]
mod nearby;
#[cfg(feature = "collision")]
mod queries;
mod random_tree;
mod random_trees;
mod resolved_rate;
#[cfg(feature = "collision")]
mod robots;
#[cfg(feature = "collision")]
mod self_collision;
#[cfg(feature = "collision")]
mod two_shapes;
#[cfg(feature = "collision")]
mod urdf_extremes;
mod urdf_loads;
mod urdf_mimic;
mod urdf_refusals;
#[cfg(all(feature = "collision", feature = "urdf-rs"))]
mod urdf_rs;
mod urdf_text;
