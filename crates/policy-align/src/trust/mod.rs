//! Assesses a learnt policy without knowing the truth.

mod along_motion;
mod extrapolated;
mod friction;
mod goals;
mod judge;
mod leaving;
mod numbers;
mod pushes;
mod report;
mod slow_starts;
mod surfaces;
mod uncertain_between;
mod unexplained;

pub(crate) use along_motion::along_the_motion;
pub(crate) use extrapolated::extrapolated;
pub(crate) use judge::{VerdictInput, judge};
pub(crate) use leaving::share_leaving;
pub use numbers::{AlignedNumbers, TrustNumbers};
pub(crate) use pushes::pushed;
pub use report::Trust;
pub(crate) use surfaces::{CommonPlane, common_point, common_surface, wall};
pub(crate) use uncertain_between::share_unknown;
