//! Files of rows: one row or message per sample, with named columns.

pub(crate) mod delimited;
mod documents;
pub(crate) mod json;
pub(crate) mod json_lines;
#[cfg(feature = "parquet")]
pub(crate) mod lerobot;
#[cfg(feature = "mcap")]
pub(crate) mod mcap;
#[cfg(feature = "mcap")]
pub(crate) mod packed;
#[cfg(feature = "parquet")]
pub(crate) mod parquet;
pub(crate) mod piece;
pub(crate) mod roles;
pub(crate) mod stamps;
mod table;
