//! The registry: every table and figure of the paper that can be reproduced, one file each.

mod asimo22;
mod exam;
mod judge;
mod table1;
mod table2;
mod three_link;

pub(crate) use table1::toy_regressor;

use std::collections::BTreeMap;

use rand_chacha::ChaCha8Rng;

use crate::measure::{Measure, RowOf};
use crate::paper::{Explanations, Printed};

/// A table or figure.
pub(crate) struct Experiment {
    /// Identifier on the command line and in the results.
    pub(crate) id: &'static str,
    /// Section of the paper.
    pub(crate) section: &'static str,
    /// One line for people.
    pub(crate) title: &'static str,
    /// Repetitions of each setup in the paper.
    pub(crate) data_sets: u32,
    /// What is fitted or left open by the paper, in a sentence or two.
    pub(crate) remark: &'static str,
    /// What is measured, in the table's order.
    pub(crate) setups: Vec<Setup>,
    /// Why single cells stand out, by row and measure: `xtask/paper/*.toml`.
    pub(crate) explanations: Explanations,
}

impl Experiment {
    /// Why a cell stands out, if that is known.
    pub(crate) fn explain(&self, row: &str, measure: Measure) -> Option<&str> {
        self.explanations.get(row)?.get(&measure).map(String::as_str)
    }
}

/// Independent data sets, each of which gives one value for every measure of every row.
pub(crate) struct Setup {
    /// Identifier, unique within the experiment.
    pub(crate) id: String,
    /// The rows, in the order of what [`Trial::run`] returns.
    pub(crate) rows: Vec<Row>,
    /// How a data set is made, learnt and scored.
    pub(crate) trial: Box<dyn Trial>,
}

/// One row of a table.
pub(crate) struct Row {
    /// Identifier, unique within the experiment.
    pub(crate) id: String,
    /// Whose errors stand in it.
    pub(crate) of: RowOf,
    /// The paper's figures for this row.
    pub(crate) paper: BTreeMap<Measure, Printed>,
}

/// What one data set gives: the measures of each row of its setup.
pub(crate) type Measures = Vec<BTreeMap<Measure, f64>>;

/// Everything that one data set of a setup needs.
pub(crate) trait Trial: Send + Sync {
    /// The system whose random stream is used: equal numbers see equal data sets.
    fn system(&self) -> u32;

    /// All parameters that determine the outcome, besides seed and code.
    fn definition(&self) -> String;

    /// Work of one data set, in any unit that all trials share; used for the time left.
    fn cost(&self) -> u64;

    /// Makes a data set, learns from it and scores what was learnt, row by row.
    fn run(&self, rng: &mut ChaCha8Rng) -> anyhow::Result<Measures>;
}

/// All experiments, in the paper's order.
pub(crate) fn registry() -> anyhow::Result<Vec<Experiment>> {
    Ok(vec![
        table1::table1()?,
        table1::table1_literal()?,
        table2::table2()?,
        asimo22::asimo22()?,
        three_link::three_link()?,
    ])
}
