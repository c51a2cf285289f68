//! How learners are compared: the same recordings, the same held-out samples, the same errors.

pub(crate) mod beside;
pub(crate) mod constraint_consistent;
pub(crate) mod contest;
pub(crate) mod entrant;
pub(crate) mod exam;
pub(crate) mod fresh;
pub(crate) mod gaussians;
pub(crate) mod judge;
pub(crate) mod observation_model;
pub(crate) mod recipe;
pub(crate) mod test_samples;
