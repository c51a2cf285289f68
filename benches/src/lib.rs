//! Data for the benchmarks.

mod toy_data;

pub use toy_data::toy_demonstrations;

pub mod lwpr_data;
