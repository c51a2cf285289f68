//! Assesses a learnt policy without knowing the truth.

mod along_motion;
mod between;
mod extrapolated;
mod freely;
mod friction;
mod goals;
mod judge;
mod numbers;
mod pushes;
mod report;
mod starts;
mod surfaces;
mod unexplained;

pub(crate) use along_motion::along_the_motion;
pub(crate) use between::share_unknown;
pub(crate) use extrapolated::extrapolated;
pub(crate) use freely::share_leaving;
pub(crate) use judge::{VerdictInput, judge};
pub use numbers::{AlignedNumbers, TrustNumbers};
pub(crate) use pushes::pushed;
pub use report::Trust;
pub(crate) use surfaces::{CommonPlane, common_point, common_surface, wall};
