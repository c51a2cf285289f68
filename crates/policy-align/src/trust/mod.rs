//! Checks of a learnt policy without the truth.

mod along_motion;
mod between;
mod common_plane;
mod common_surface;
mod freely;
mod friction;
mod goals;
mod judge;
mod numbers;
mod pushes;
mod quadratics;
mod report;
mod starts;
mod unexplained;

pub(crate) use along_motion::along_the_motion;
pub(crate) use between::share_unknown;
pub(crate) use common_plane::CommonPlane;
pub(crate) use common_surface::common_surface;
pub(crate) use freely::share_leaving;
pub(crate) use judge::{VerdictInput, judge};
pub use numbers::{AlignedNumbers, TrustNumbers};
pub(crate) use pushes::pushed;
pub use report::Trust;
