//! All tests except those inside modules, in one program: common code is compiled once, and tests run in parallel.

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
