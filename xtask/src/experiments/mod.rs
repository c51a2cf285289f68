//! The registry: every table and figure of the paper that can be reproduced, one file each.

mod scoring;
mod table1;

use std::collections::BTreeMap;

use rand_chacha::ChaCha8Rng;

use crate::measure::Measure;
use crate::paper::{Explanations, Printed};

/// A table or figure: a list of rows, each measured on independent data sets.
pub(crate) struct Experiment {
    /// Identifier on the command line and in the results.
    pub(crate) id: &'static str,
    /// Section of the paper.
    pub(crate) section: &'static str,
    /// One line for people.
    pub(crate) title: &'static str,
    /// Repetitions of each row in the paper.
    pub(crate) data_sets: u32,
    /// What is fitted or left open by the paper, in a sentence or two.
    pub(crate) remark: &'static str,
    /// The rows, in the table's order.
    pub(crate) rows: Vec<Row>,
    /// Why single cells stand out, by row and measure: `xtask/paper/*.toml`.
    pub(crate) explanations: Explanations,
}

impl Experiment {
    /// Why a cell stands out, if that is known.
    pub(crate) fn explain(&self, row: &str, measure: Measure) -> Option<&str> {
        self.explanations.get(row)?.get(&measure).map(String::as_str)
    }
}

/// One row of a table.
pub(crate) struct Row {
    /// Identifier, unique within the experiment.
    pub(crate) id: String,
    /// The paper's figures for this row.
    pub(crate) paper: BTreeMap<Measure, Printed>,
    /// How a data set of this row is made, learnt and scored.
    pub(crate) trial: Box<dyn Trial>,
}

/// Everything that one data set of one row needs.
pub(crate) trait Trial: Send + Sync {
    /// The system whose random stream is used: equal numbers see equal data sets.
    fn system(&self) -> u32;

    /// All parameters that determine the outcome, besides seed and code.
    fn definition(&self) -> String;

    /// Work of one data set, in any unit that all trials share; used for the time left.
    fn cost(&self) -> u64;

    /// Makes a data set, learns from it and scores what was learnt.
    fn run(&self, rng: &mut ChaCha8Rng) -> anyhow::Result<BTreeMap<Measure, f64>>;
}

/// All experiments, in the paper's order.
pub(crate) fn registry() -> anyhow::Result<Vec<Experiment>> {
    Ok(vec![table1::table1()?, table1::table1_literal()?])
}
