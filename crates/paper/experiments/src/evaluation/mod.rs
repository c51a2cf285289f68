//! Comparison of learners on the same recordings, held-out samples and errors.

pub(crate) mod baselines;
pub(crate) mod candidate;
pub(crate) mod comparison;
pub(crate) mod constraint_consistent;
pub(crate) mod fresh;
pub(crate) mod gaussians;
pub(crate) mod judge;
pub(crate) mod lwpr_learners;
pub(crate) mod observation_model;
pub(crate) mod protocol;
pub(crate) mod recipe;
pub(crate) mod test_samples;
