//! The paper's printed numbers, as data.

use std::collections::BTreeMap;

use anyhow::Context as _;
use serde::{Deserialize, Serialize};

use crate::measure::Measure;
use crate::variants::{Cell, Quote, Variants, quotes};

/// Mean and standard deviation over data sets, as printed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Printed {
    /// Mean.
    pub mean: f64,
    /// Sample standard deviation.
    pub sd: f64,
}

/// Printed numbers by row and measure.
pub type PaperTable = BTreeMap<String, BTreeMap<Measure, Printed>>;

/// Reads one of the files in `crates/paper/experiments/paper`.
pub(crate) fn paper_table(text: &str) -> anyhow::Result<PaperTable> {
    toml::from_str(text).context("the paper's figures (crates/paper/experiments/paper/*.toml) cannot be read")
}

/// The row of [`Explanations`] that applies to all rows without a text.
pub(crate) const EVERY_ROW: &str = "every-row";

/// Explanations of single cells that stand out.
#[derive(Debug, Default)]
pub struct Explanations {
    /// Sentences, by row and measure.
    pub texts: BTreeMap<String, BTreeMap<Measure, String>>,
    /// The quotes in the texts, each with its cell.
    pub quotes: Vec<(Quote, Cell)>,
}

/// Reads an experiment's explanations from one of the files in `crates/paper/experiments/paper`.
pub(crate) fn explanations(experiment: &str, text: &str) -> anyhow::Result<Explanations> {
    let read = || {
        let mut explanations = Explanations { texts: toml::from_str(text)?, quotes: Vec::new() };
        let variants = Variants::committed()?;
        for (row, texts) in &mut explanations.texts {
            for (&measure, text) in texts {
                let own = (row.clone(), measure);
                explanations.quotes.extend(quotes(&own, text)?);
                *text = variants.filled(experiment, &own, text)?;
            }
        }
        Ok::<_, anyhow::Error>(explanations)
    };
    read().context("the explanations (crates/paper/experiments/paper/*-explained.toml) cannot be read")
}
