//! Checks of a learnt policy without the truth.

mod between;
mod freely;
mod goals;
mod judge;
mod numbers;
mod report;

pub(crate) use between::share_unknown;
pub(crate) use freely::share_leaving;
pub(crate) use goals::differing_goals;
pub(crate) use judge::{VerdictInput, judge};
pub use numbers::{AlignedNumbers, TrustNumbers};
pub use report::Trust;
