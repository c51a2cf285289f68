//! All integration tests in one program, so that shared code is compiled once and the tests run in parallel.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod all_rows;
mod bounds_on_errors;
mod constraint_estimates;
mod context;
mod drawn;
mod fits;
mod free_rows;
mod fresh;
mod fresh_movements;
mod goals;
mod identities;
mod kernels;
mod known_switches;
mod many_states;
mod metric;
mod model;
mod more_movements;
mod pushed;
mod reading;
mod rows;
mod scales;
mod stored;
mod systems;
mod task_spaces;
