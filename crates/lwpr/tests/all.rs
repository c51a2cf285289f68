//! All integration tests in one program, so that shared code is compiled once and the tests run in parallel.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod bad_input;
mod derivatives;
mod golden;
mod prediction;
mod standardised;
mod stored;
mod support;
mod training;
