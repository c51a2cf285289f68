//! From a laboratory's recordings to a policy that one can trust, or to the reason why not.

mod canonical;
mod constraint_file;
mod constraint_set;
mod decision;
mod export;
mod joint_limits;
mod learnt;
mod link_point;
mod model;
mod model_error;
mod model_file;
mod model_policy;
mod roll_out;
mod roll_out_error;
mod runge_kutta;
mod trust;
mod whole_file;

pub use canonical::sha256;
pub use constraint_file::ConstraintFileError;
pub use constraint_set::ConstraintSet;
pub use decision::Decision;
pub use export::{CSource, ExportError, Precision, to_onnx};
pub use joint_limits::JointLimits;
pub use learnt::Learnt;
pub use model::{DataSummary, FileSummary, LeftOutEpisode, MadeBy, Model, StateChannel};
pub use model_error::ModelError;
pub use model_policy::{ModelPolicy, ModelPotential};
pub use roll_out::{Path, RollOut, Stop};
pub use roll_out_error::RollOutError;
pub use trust::{Finding, Trust, Verdict};
pub use whole_file::write_whole;
