//! Locally weighted projection regression.

// Code under `pulp::Arch::dispatch` is compiled for the processor at hand only where it is inlined.
#![allow(clippy::inline_always)]
// Several rows run in step, and lanes are numbered.
#![allow(clippy::needless_range_loop)]

mod activation;
mod batch;
mod batch_fit;
mod birth;
mod chunk;
mod contribution;
mod error;
mod exponential;
mod field;
mod field_table;
mod full_metric;
mod kernel;
mod lane_block;
mod local_model;
mod metric;
mod model;
mod model_record;
mod number;
mod params;
mod predictor;
mod predictor_record;
mod receptive_field;
mod regression;
mod settings;
mod sub_model;
mod training;

pub use error::{LwprError, Side};
pub use kernel::Kernel;
pub use model::Lwpr;
pub use params::{LwprParams, Metric, MetricAdaptation, Pruning};
pub use predictor::{Prediction, Predictor};
pub use receptive_field::ReceptiveField;
