//! All integration tests in one program, so that shared code is compiled once and the tests run in parallel.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod bad_input;
mod checks;
mod drawn;
mod golden;
mod invariance;
mod learning;
mod literal;
mod objective;
mod stored;
