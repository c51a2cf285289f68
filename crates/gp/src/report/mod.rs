//! Reliability of a slope GP, in numbers and in words.

pub(crate) mod identifiability;
pub(crate) mod trust_report;
