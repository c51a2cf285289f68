//! All tests but those of the modules themselves, in one program: what they share is compiled once, and they run side by side.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod bad_input;
mod fusion;
mod golden;
mod literal;
mod noise;
mod savitzky_golay;
mod smoother;
mod threads;
