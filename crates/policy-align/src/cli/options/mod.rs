//! Flags and configuration files.

pub(crate) mod config;
pub(crate) mod flags;
pub(crate) mod rollout_flags;
pub(crate) mod values;
pub(crate) mod without_effect;
