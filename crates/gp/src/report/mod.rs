//! Reliability of a slope GP, in numbers and as doubts.

pub(crate) mod doubt;
pub(crate) mod identifiability;
pub(crate) mod trust_report;
