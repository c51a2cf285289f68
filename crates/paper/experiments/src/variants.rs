//! Results at settings that are not in use, which texts quote: the value of a cell if one setting has another value.
//!
//! `{passes of the regression = 1}` in `paper/*-explained.toml` stands for the explained cell's mean over the first
//! data sets of a seed; `{passes of the regression = 1: row measure}` for that of another cell. `cargo xtask leverage`
//! measures them.

use std::collections::BTreeMap;

use anyhow::Context as _;
use metrics::Summary;
use serde::{Deserialize, Serialize};

use crate::measure::Measure;

/// The committed file.
const COMMITTED: &str = include_str!("../../../../docs/records/variants.json");

/// Row and measure.
pub type Cell = (String, Measure);

/// The values of cells over the data sets, by row and measure.
type Cells = BTreeMap<String, BTreeMap<Measure, Vec<f64>>>;

/// A quote of a cell with another value of a setting.
#[derive(Debug, Clone, PartialEq)]
pub struct Quote {
    /// The setting's name.
    pub setting: String,
    /// Its value.
    pub value: f64,
    /// Both, as written in the text.
    variant: String,
}

/// The measured values.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Variants {
    /// Seed of the data sets.
    seed: u64,
    /// By experiment and "setting = value".
    cells: BTreeMap<String, BTreeMap<String, Cells>>,
}

impl Variants {
    /// Without any values.
    pub fn from_seed(seed: u64) -> Variants {
        Variants { seed, cells: BTreeMap::new() }
    }

    /// The committed values, which texts quote.
    ///
    /// # Errors
    /// If the file is damaged.
    pub fn committed() -> anyhow::Result<Variants> {
        serde_json::from_str(COMMITTED).context("docs/records/variants.json is damaged")
    }

    /// Formats the values like the committed file.
    ///
    /// # Errors
    /// If a number is not finite.
    pub fn json(&self) -> anyhow::Result<String> {
        Ok(serde_json::to_string_pretty(self)? + "\n")
    }

    /// Adds the values of a cell.
    pub fn add(&mut self, experiment: &str, quote: &Quote, (row, measure): &Cell, values: Vec<f64>) {
        let variants = self.cells.entry(experiment.to_owned()).or_default();
        let cells = variants.entry(quote.variant.clone()).or_default();
        cells.entry(row.clone()).or_default().insert(*measure, values);
    }

    /// The mean of a cell, if it was measured.
    fn mean(&self, experiment: &str, quote: &Quote, (row, measure): &Cell) -> Option<f64> {
        let values = self.cells.get(experiment)?.get(&quote.variant)?.get(row)?.get(measure)?;
        Some(Summary::of(values).ok()?.mean)
    }

    /// Replaces the quotes in a text about a cell by numbers; quotes without measurements remain in braces.
    ///
    /// # Errors
    /// If a quote does not consist of a known setting and value, or of a known cell.
    pub fn filled(&self, experiment: &str, own: &Cell, text: &str) -> anyhow::Result<String> {
        let mut filled = String::new();
        for part in parts(text, own)? {
            match part {
                Part::Words(words) => filled += words,
                Part::Quote(written, quote, cell) => match self.mean(experiment, &quote, &cell) {
                    Some(mean) => filled += &two_digits(mean),
                    None => filled.extend(["{", written, "}"]),
                },
            }
        }
        Ok(filled)
    }
}

/// Rounds to two significant digits, as in texts: 0.0028, 0.43, 8.4.
pub fn two_digits(value: f64) -> String {
    let decimals = (1.0 - value.log10().floor()).max(0.0) as usize;
    format!("{value:.decimals$}")
}

/// The quotes in a text about a cell, each with its cell.
///
/// # Errors
/// As [`Variants::filled`].
pub fn quotes(own: &Cell, text: &str) -> anyhow::Result<Vec<(Quote, Cell)>> {
    let quoted = |part| match part {
        Part::Words(_) => None,
        Part::Quote(_, quote, cell) => Some((quote, cell)),
    };
    Ok(parts(text, own)?.into_iter().filter_map(quoted).collect())
}

enum Part<'t> {
    Words(&'t str),
    /// As written, and as parsed.
    Quote(&'t str, Quote, Cell),
}

fn parts<'t>(text: &'t str, own: &Cell) -> anyhow::Result<Vec<Part<'t>>> {
    let mut parts = Vec::new();
    let mut rest = text;
    while let Some((words, after)) = rest.split_once('{') {
        let (written, after) = after.split_once('}').with_context(|| format!("no closing brace: {text}"))?;
        let (quote, cell) = quote(written, own)?;
        parts.extend([Part::Words(words), Part::Quote(written, quote, cell)]);
        rest = after;
    }
    parts.push(Part::Words(rest));
    Ok(parts)
}

/// Parses `setting = value`, for the text's own cell, or `setting = value: row measure`.
fn quote(written: &str, own: &Cell) -> anyhow::Result<(Quote, Cell)> {
    let (variant, cell) = written.split_once(": ").map_or((written, None), |(variant, cell)| (variant, Some(cell)));
    let (setting, value) = variant.rsplit_once(" = ").with_context(|| format!("not setting = value: {written}"))?;
    let value = value.parse().with_context(|| format!("not a number: {written}"))?;
    let cell = match cell {
        None => own.clone(),
        Some(cell) => {
            let (row, measure) = cell.split_once(' ').with_context(|| format!("not row and measure: {written}"))?;
            let measure = serde_json::from_value(measure.into()).with_context(|| format!("no measure: {written}"))?;
            (row.to_owned(), measure)
        }
    };
    Ok((Quote { setting: setting.to_owned(), value, variant: variant.to_owned() }, cell))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seed::generator;
    use crate::{quotable, registry};

    fn cell(row: &str, measure: Measure) -> Cell {
        (row.to_owned(), measure)
    }

    #[test]
    fn a_quote_names_a_setting_and_perhaps_a_cell() {
        let own = cell("narrow", Measure::Nupe);
        let (gap, of_gap) = quote("narrowest gap, m = 0", &own).unwrap();
        assert_eq!((gap.setting.as_str(), gap.value, of_gap), ("narrowest gap, m", 0.0, own.clone()));
        assert_eq!(quote("passes = 1: wide ncpe_all", &own).unwrap().1, cell("wide", Measure::NcpeAll));
        for damaged in ["passes", "passes = many", "passes = 1: wide", "passes = 1: wide breadth"] {
            assert!(quote(damaged, &own).is_err(), "{damaged}");
        }
        assert!(quotes(&own, "passes {passes = 1").is_err());
    }

    #[test]
    fn quotes_are_replaced_by_their_numbers() {
        let own = cell("wide", Measure::Nupe);
        let mut variants = Variants::from_seed(1);
        for (written, value) in [("passes = 1", 0.0314), ("passes = 2", 4.0)] {
            let (quote, cell) = quote(written, &own).unwrap();
            variants.add("table1", &quote, &cell, vec![value, 3.0 * value]);
        }
        let filled = |text| variants.filled("table1", &own, text).unwrap();
        assert_eq!(filled("one: {passes = 1}, two: {passes = 2: wide nupe}."), "one: 0.063, two: 8.0.");
        assert_eq!(filled("{passes = 3} of {passes = 2: narrow nupe}"), "{passes = 3} of {passes = 2: narrow nupe}");
    }

    #[test]
    fn no_quote_is_left_unfilled() {
        for experiment in registry().unwrap() {
            let texts = experiment.explanations.texts.values().flat_map(BTreeMap::values);
            for text in texts {
                assert!(!text.contains(['{', '}']), "{}: {text}", experiment.id);
            }
        }
    }

    /// The program reproduces the committed values, on the first data set of variants that are quick to compute.
    #[test]
    fn committed_variants_are_what_the_program_computes() {
        let variants = Variants::committed().unwrap();
        for name in ["held-out share", "movements"] {
            let setting = quotable().find(|setting| setting.name == name).unwrap();
            let found = variants.cells["table1"].iter().find(|(variant, _)| variant.starts_with(name));
            let (variant, cells) = found.unwrap();
            let value: f64 = variant.rsplit_once(" = ").unwrap().1.parse().unwrap();
            for setup in (setting.with)(value).unwrap() {
                let Some(committed) = cells.get(&setup.rows[0].id) else { continue };
                let rows = setup.trial.run(&mut generator(variants.seed, setup.system, 0)).unwrap();
                for (measure, values) in committed {
                    let (ours, theirs) = (rows[0][measure], values[0]);
                    assert!((ours - theirs).abs() <= 1e-6 * theirs.abs(), "{variant} {}: {ours} {theirs}", setup.id);
                }
            }
        }
    }
}
