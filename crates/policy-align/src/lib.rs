//! From a laboratory's recordings to a policy that one can trust, or to the reason why not.
//!
//! [`prepare`] makes demonstrations of [`demo_io::Recordings`]; [`fit`] learns from them and says how far to trust what
//! came of it; [`evaluate`] holds a policy against other recordings. Every decision that is taken for the user is a
//! [`Decision`], every doubt a [`Finding`].

mod decision;
mod error;
mod evaluate;
mod fit;
mod learnt;
mod model;
mod prepare;
mod trust;

pub use decision::Decision;
pub use error::{FitError, PrepareError};
pub use evaluate::{EvaluateError, Evaluation, Truth, evaluate};
pub use fit::{Fit, FitOptions, LearnerChoice, Progress, Step, fit};
pub use learnt::Learnt;
pub use model::{DataSummary, FileSummary, LeftOutEpisode, MadeBy, Model, StateChannel};
pub use prepare::{Noise, PrepareOptions, Prepared, Recorded, VelocityUse, prepare};
pub use trust::{AlignedNumbers, Finding, Trust, TrustNumbers, Verdict};
