//! All tests but those of the modules themselves, in one program: what they share is compiled once, and they run side by side.

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
