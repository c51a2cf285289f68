//! The experiments of the paper: every table and figure of it that can be reproduced, one file each, with what the paper
//! prints and what a run of them comes to.
//!
//! - [`registry`]: all of them. An [`Experiment`] has [`Setup`]s, and each of these a [`Trial`], which makes a data set from a
//!   generator of [`seed`], learns from it and scores what was learnt: an [`outcome::Outcome`].
//! - [`summary`]: what outcomes come to, beside the printed figures; [`results`]: the form in which that is kept.
//! - [`settings`]: what is fitted; [`leverage`]: how much hangs on it; [`variants`]: numbers that texts quote of other settings.
//!
//! Whoever runs them decides on threads, files and progress.

mod evaluation;
pub mod leverage;
pub mod measure;
pub mod outcome;
pub mod paper;
mod parameters;
pub mod results;
mod robots;
pub mod seed;
mod setting;
mod settings;
pub mod summary;
mod tables;
pub mod variants;
pub mod verdict;

pub use evaluation::baselines::{Baselines, DATA_SETS};
pub use evaluation::comparison::{Comparison, Entry, Method};
pub use evaluation::gaussians::Gaussians;
pub use evaluation::judge::Judge;
pub use evaluation::recipe::HELD_OUT;
pub use evaluation::test_samples::TestSamples;
pub use parameters::Parameters;
pub use robots::upper_body;
pub use setting::{Class, Setting, shown};
pub use settings::{n_fitted, quotable, settings};
pub use tables::beyond::case_on_the_plane;
pub use tables::figure6::{BANDWIDTHS, BASELINES_LEFT, BASELINES_RIGHT, NOISE_PERCENT, RULES, TRAJECTORIES_PERCENT};
pub use tables::figure9::{Distance, TENTHS, line};
pub use tables::table1::{PARABOLA_SYSTEM, SINUSOIDAL_SYSTEM, toy_baselines, toy_naive, toy_regressor};
pub use tables::table2::{GRASP_SYSTEM, grasp, grasp_baselines, grasp_naive, grasp_regressor};
pub use tables::three_link::{ARM_SYSTEM, arm};

use std::collections::BTreeMap;

use anyhow::ensure;
use rand_chacha::ChaCha8Rng;

use evaluation::protocol::TESTED_ON;

use crate::measure::{Measure, RowOf};
use crate::paper::{EVERY_ROW, Explanations, PaperTable, Printed};

/// A table or figure.
#[derive(Default)]
pub struct Experiment {
    /// Identifier on the command line and in the results.
    pub id: &'static str,
    /// Section of the paper.
    pub section: &'static str,
    /// One line for people.
    pub title: &'static str,
    /// Repetitions of each setup in the paper.
    pub data_sets: u32,
    /// What is fitted or left open by the paper, in a sentence or two.
    pub remark: &'static str,
    /// What its numbers do not show: statements of the paper that do not hold here, and other reservations, a sentence each.
    pub reservations: &'static [&'static str],
    /// The page of `docs/decisions` on why it is done so.
    pub decisions: &'static str,
    /// The experiment of which it is another reading: its cells are no further figures of the paper.
    pub another_reading_of: Option<&'static str>,
    /// What has to be said beside the table of learners.
    pub comparisons_remark: Option<&'static str>,
    /// Learners compared, a line for each error; empty where there is one learner alone.
    pub comparisons: Vec<Comparison>,
    /// What is measured, in the table's order.
    pub setups: Vec<Setup>,
    /// The printed figures: `crates/paper/experiments/paper/*.toml`; empty where the paper shows curves only.
    pub paper: PaperTable,
    /// Why single cells stand out: `crates/paper/experiments/paper/*-explained.toml`.
    pub explanations: Explanations,
}

impl Experiment {
    /// All rows, in the table's order.
    pub fn rows(&self) -> impl Iterator<Item = &Row> {
        self.setups.iter().flat_map(|setup| &setup.rows)
    }

    /// The printed figure of a cell.
    pub fn paper(&self, row: &str, measure: Measure) -> Option<Printed> {
        self.paper.get(row)?.get(&measure).copied()
    }

    /// Fails if the printed figures and the rows do not belong together, as after a slip in a name.
    fn checked(self) -> anyhow::Result<Self> {
        let of_paper = |row: &&Row| !self.paper.is_empty() && row.of != RowOf::Additional;
        for row in self.rows().filter(of_paper) {
            ensure!(
                self.paper.contains_key(&row.id),
                "{}: crates/paper/experiments/paper has no row {}",
                self.id,
                row.id
            );
        }
        for id in self.paper.keys().chain(self.explanations.texts.keys()) {
            ensure!(
                id == EVERY_ROW || self.rows().any(|row| row.id == *id),
                "{}: crates/paper/experiments/paper has a row {id} that is not run",
                self.id
            );
        }
        for entry in self.comparisons.iter().flat_map(|comparison| &comparison.entries) {
            let (id, row) = (self.id, &entry.row);
            ensure!(self.rows().any(|other| other.id == *row), "{id}: a comparison has a row {row} that is not run");
        }
        Ok(self)
    }

    /// Why a cell stands out and what was tried, if that is known: of its row, or else of every row.
    pub fn explain(&self, row: &str, measure: Measure) -> Option<&str> {
        let of = |row: &str| self.explanations.texts.get(row)?.get(&measure);
        of(row).or_else(|| of(EVERY_ROW)).map(String::as_str)
    }
}

/// Independent data sets, each of which gives one value for every measure of every row.
pub struct Setup {
    /// Identifier, unique within the experiment.
    pub id: String,
    /// The rows, in the order of what [`Trial::run`] returns.
    pub rows: Vec<Row>,
    /// The system whose random stream is used: equal numbers see equal data sets.
    pub system: u32,
    /// How many data sets it sees, where not as many as the experiment has: then the first ones.
    pub data_sets: Option<u32>,
    /// Work of one data set, in any unit that all setups share; used for the time left.
    pub cost: u64,
    /// How a data set is made, learnt and scored.
    pub trial: Box<dyn Trial>,
}

impl Setup {
    /// A setup that sees as many data sets as its experiment.
    fn new(id: &str, system: u32, cost: u64, rows: Vec<Row>, trial: impl Trial + 'static) -> Setup {
        Setup { id: id.to_owned(), rows, system, data_sets: None, cost, trial: Box::new(trial) }
    }

    /// How many data sets it sees in its experiment.
    pub fn data_sets_of(&self, experiment: &Experiment) -> u32 {
        self.data_sets.unwrap_or(experiment.data_sets)
    }

    /// Whether its rows only hold learners against each other.
    pub fn is_of_comparisons(&self) -> bool {
        self.rows.iter().all(|row| row.of == RowOf::Additional)
    }
}

/// One row of a table.
pub struct Row {
    /// Identifier, unique within the experiment.
    pub id: String,
    /// Whose errors stand in it.
    pub of: RowOf,
    /// Which samples its errors are of.
    pub(crate) tested_on: &'static str,
}

impl Row {
    /// A row of a learner's errors in an evaluation.
    fn of_learner(id: &str) -> Row {
        Row { id: id.to_owned(), of: RowOf::Learner, tested_on: TESTED_ON }
    }
}

/// What one data set gives: the measures of each row of its setup.
pub type Measures = Vec<BTreeMap<Measure, f64>>;

/// Everything that one data set of a setup needs.
pub trait Trial: Parameters + Send + Sync {
    /// Makes a data set, learns from it and scores what was learnt, row by row.
    ///
    /// # Errors
    /// If it cannot be made, learnt or scored.
    fn run(&self, rng: &mut ChaCha8Rng) -> anyhow::Result<Measures>;
}

/// All experiments, in the paper's order.
///
/// # Errors
/// If what the paper prints, or a file of a robot, does not fit them.
pub fn registry() -> anyhow::Result<Vec<Experiment>> {
    let experiments = [
        tables::table1::table1()?,
        tables::table1::table1_literal()?,
        tables::figure6::figure6_left(),
        tables::figure6::figure6_right(),
        tables::table2::table2()?,
        tables::asimo22::asimo22()?,
        tables::three_link::three_link()?,
        tables::figure9::figure9()?,
        tables::beyond::beyond(),
        tables::readings::readings(),
        tables::constraints::constraints()?,
    ];
    experiments.into_iter().map(Experiment::checked).collect()
}
