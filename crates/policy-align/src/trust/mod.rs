//! Checks of a learnt policy without the truth.

mod between;
mod common_plane;
mod direction;
mod freely;
mod judge;
mod numbers;
mod report;

pub(crate) use between::share_unknown;
pub(crate) use common_plane::CommonPlane;
pub use direction::direction_by_channels;
pub(crate) use direction::sum_of_parts;
pub(crate) use freely::share_leaving;
pub(crate) use judge::{VerdictInput, judge};
pub use numbers::{AlignedNumbers, TrustNumbers};
pub use report::Trust;
