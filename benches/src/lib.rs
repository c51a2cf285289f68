//! Data for the benchmarks.

mod cpu;
mod toy_data;

pub use cpu::cpu_seconds;
pub use toy_data::toy_demonstrations;

pub mod lwpr_data;
