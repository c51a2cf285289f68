//! The commands, one per file.

pub(crate) mod check;
pub(crate) mod constraints;
pub(crate) mod convert;
pub(crate) mod evaluate;
pub(crate) mod export;
pub(crate) mod fit;
pub(crate) mod generated;
pub(crate) mod info;
pub(crate) mod plot;
pub(crate) mod predict;
pub(crate) mod rollout;
pub(crate) mod serve;
