//! How far a learnt policy can be trusted, without knowing the truth.

mod finding;
mod freely;
mod judge;
mod numbers;
mod words;

pub use finding::{Finding, Trust, Verdict};
pub(crate) use freely::share_leaving;
pub(crate) use judge::{Evidence, judge};
pub use numbers::{AlignedNumbers, TrustNumbers};
