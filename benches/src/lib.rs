//! Data for the benchmarks.

mod noisy_file;
mod process;
mod toy_data;

pub use noisy_file::{Wells, write_noisy};
pub use process::{cpu_seconds, peak_megabytes};
pub use toy_data::toy_demonstrations;

pub mod lwpr_data;
