//! How far a learnt policy can be trusted, without knowing the truth.

mod between;
mod finding;
mod freely;
mod judge;
mod numbers;
mod words;

pub(crate) use between::share_unknown;
pub use finding::{Finding, Trust, Verdict};
pub(crate) use freely::share_leaving;
pub(crate) use judge::{Evidence, judge};
pub use numbers::{AlignedNumbers, TrustNumbers};
