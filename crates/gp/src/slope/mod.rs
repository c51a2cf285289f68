//! The slope GP.

pub(crate) mod all_rows;
pub(crate) mod candidate;
pub(crate) mod cross_path;
pub(crate) mod data;
pub(crate) mod expansion;
pub(crate) mod fit;
pub(crate) mod judgement;
pub(crate) mod least_hidden;
pub(crate) mod model;
pub(crate) mod policy;
pub(crate) mod push_test;
pub(crate) mod pushed;
pub(crate) mod search;
pub(crate) mod slope_gp;
