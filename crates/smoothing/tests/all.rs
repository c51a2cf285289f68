//! All integration tests in one program, so that shared code is compiled once and the tests run in parallel.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod bad_input;
mod fusion;
mod golden;
mod literal;
mod noise;
mod savitzky_golay;
mod smoother;
mod threads;
