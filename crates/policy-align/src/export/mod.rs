//! Export of models as stand-alone programs.

mod c;
mod c_gp;
mod c_lwpr;
mod c_policy;
mod error;
mod lerobot;
mod lwpr_tables;
mod onnx;
mod onnx_gp;
mod onnx_graph;
mod onnx_lwpr;
mod protobuf;
mod support_radius;
mod tables;

pub use c::{CSource, Precision};
pub use error::ExportError;
pub use lerobot::to_lerobot;
pub use onnx::to_onnx;
