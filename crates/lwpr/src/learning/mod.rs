//! Training of receptive fields: one sample at a time, or a batch field by field.

pub(crate) mod activation;
pub(crate) mod activation_table;
mod batch;
mod chunk;
pub(crate) mod full_metric;
mod lane_block;
pub(crate) mod memory;
mod metric;
pub(crate) mod passes;
mod regression;
pub(crate) mod rules;
mod step;
pub(crate) mod sub_model;
