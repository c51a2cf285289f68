//! From a laboratory's recordings to a policy that one can trust, or to the reason why not.
//!
//! [`prepare()`] makes demonstrations of [`demo_io::Recordings`]; [`fit`] learns from them and says how far to trust what
//! came of it; [`evaluate`] holds a policy against other recordings. Every decision that is taken for the user is a
//! [`Decision`], every doubt a [`Finding`].
//!
//! A [`Model`] is what is kept: [`Model::save`], [`Model::load`], and [`Model::policy`] in the units of the recording.
//! [`RollOut`] follows it under constraints, [`CSource`] and [`to_onnx`] make a program of it that needs nothing else.

mod error;
mod evaluate;
mod export;
mod fit;
mod halton;
mod learnt;
mod leave_out;
mod model;
mod model_policy;
mod roll_out;
mod stored;
mod trust;

pub use error::FitError;
pub use evaluate::{EvaluateError, Evaluation, Truth, evaluate};
pub use export::{CSource, ExportError, Precision, to_onnx};
pub use fit::{Fit, FitOptions, LearnerChoice, Progress, Step, fit};
pub use learnt::Learnt;
pub use leave_out::{ConstraintLeftOut, leave_constraints_out};
pub use model::{DataSummary, FileSummary, MadeBy, Model};
pub use model_policy::{ModelPolicy, ModelPotential};
pub use prepare::{
    Decision, Finding, LeftOutEpisode, Noise, PrepareError, PrepareOptions, Prepared, Recorded, Repair, Smoothing,
    StateChannel, VelocityUse, Verdict, prepare,
};
pub use roll_out::{ConstraintFileError, ConstraintSet, JointLimits, Path, RollOut, RollOutError, Stop, spread_starts};
pub use stored::{ModelError, sha256, sha256_of_file, write_whole};
pub use trust::{AlignedNumbers, Trust, TrustNumbers};
