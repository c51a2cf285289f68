//! The paper's printed figures, as data.

use std::collections::BTreeMap;

use anyhow::Context as _;
use serde::{Deserialize, Serialize};

use crate::measure::Measure;

/// Mean and standard deviation over data sets, as printed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Printed {
    /// Mean.
    pub(crate) mean: f64,
    /// Sample standard deviation.
    pub(crate) sd: f64,
}

/// Printed figures by row and measure.
pub(crate) type PaperTable = BTreeMap<String, BTreeMap<Measure, Printed>>;

/// Reads one of the files in `xtask/paper`.
pub(crate) fn paper_table(text: &str) -> anyhow::Result<PaperTable> {
    toml::from_str(text).context("the paper's figures (xtask/paper/*.toml) cannot be read")
}

/// Sentences on single cells, by row and measure.
pub(crate) type Explanations = BTreeMap<String, BTreeMap<Measure, String>>;

/// Reads why single cells stand out, from one of the files in `xtask/paper`.
pub(crate) fn explanations(text: &str) -> anyhow::Result<Explanations> {
    toml::from_str(text).context("the explanations (xtask/paper/*-explained.toml) cannot be read")
}
