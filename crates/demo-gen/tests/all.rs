//! All tests but those of the modules themselves, in one program: what they share is compiled once, and they run side by side.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod bad_input;
mod beyond;
mod grasp;
mod noise;
mod potentials;
mod robot_scenarios;
mod robots;
mod roll_outs;
mod tasks;
mod toy_systems;
mod upper_body;
