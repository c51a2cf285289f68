//! How far a slope GP can be trusted, in numbers and in words.

pub(crate) mod identifiability;
pub(crate) mod trust_report;
