//! The direct GP.

pub(crate) mod data;
pub(crate) mod direct_gp;
pub(crate) mod learner;
pub(crate) mod model;
