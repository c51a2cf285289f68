//! The noise of samples, and its treatment.

pub(crate) mod least_noisy;
pub(crate) mod noise;
pub(crate) mod smooth;
pub(crate) mod still;
pub(crate) mod thinning;
