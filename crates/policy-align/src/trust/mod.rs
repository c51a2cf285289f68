//! Checks of a learnt policy without the truth.

mod between;
mod common_plane;
mod freely;
mod friction;
mod goals;
mod judge;
mod numbers;
mod pushes;
mod report;

pub(crate) use between::share_unknown;
pub(crate) use common_plane::CommonPlane;
pub(crate) use freely::share_leaving;
pub(crate) use friction::friction;
pub(crate) use goals::differing_goals;
pub(crate) use judge::{VerdictInput, judge};
pub use numbers::{AlignedNumbers, TrustNumbers};
pub(crate) use pushes::pushed;
pub use report::Trust;
