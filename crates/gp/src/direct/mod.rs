//! The direct GP.

pub(crate) mod data;
pub(crate) mod direct_gp;
pub(crate) mod free_rows;
pub(crate) mod model;
