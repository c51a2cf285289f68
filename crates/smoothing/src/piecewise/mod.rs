//! The piecewise-polynomial smoother, (S15) and (S16).

pub(crate) mod averages;
pub(crate) mod evidence;
pub(crate) mod noise_by_evidence;
pub(crate) mod polynomials;
pub(crate) mod scaled;
pub(crate) mod segmentation;
pub(crate) mod smoothed;
pub(crate) mod smoother;
pub(crate) mod windows;
