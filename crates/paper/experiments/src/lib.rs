//! The experiments of the paper: every reproducible table and figure, one file each, with the printed numbers and the results of a
//! run.
//!
//! - [`registry`]: all experiments. An [`Experiment`] has [`Setup`]s, and each of these a [`Trial`], which generates a data set from
//!   a generator of [`seed`], learns from it and measures the errors: an [`outcome::Outcome`].
//! - [`summary`]: summarises outcomes and compares them with the printed numbers; [`results`]: the file format of the results.
//! - [`settings`]: fitted settings; [`leverage`]: their effect on verdicts; [`variants`]: numbers at other settings that texts quote.
//!
//! The caller chooses threads, files and progress displays.

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

/// A table or figure of the paper, or an additional one.
#[derive(Default)]
pub struct Experiment {
    /// Identifier on the command line and in the results.
    pub id: &'static str,
    /// Section of the paper.
    pub section: &'static str,
    /// A one-line title.
    pub title: &'static str,
    /// Number of data sets of each setup in the paper.
    pub data_sets: u32,
    /// Settings that are fitted or that the paper leaves open, in a sentence or two.
    pub remark: &'static str,
    /// Reservations that the numbers do not show, such as statements of the paper that do not hold here, a sentence each.
    pub reservations: &'static [&'static str],
    /// The page of `docs/decisions` with the reasons.
    pub decisions: &'static str,
    /// The experiment of which it is another reading; its cells do not count as additional numbers of the paper.
    pub another_reading_of: Option<&'static str>,
    /// A remark for the table of learners.
    pub comparisons_remark: Option<&'static str>,
    /// Comparisons of learners, a line for each error; empty if there is only one learner.
    pub comparisons: Vec<Comparison>,
    /// The measured setups, in the table's order.
    pub setups: Vec<Setup>,
    /// The printed numbers: `crates/paper/experiments/paper/*.toml`; empty if the paper shows only curves.
    pub paper: PaperTable,
    /// Why single cells stand out: `crates/paper/experiments/paper/*-explained.toml`.
    pub explanations: Explanations,
}

impl Experiment {
    /// All rows, in the table's order.
    pub fn rows(&self) -> impl Iterator<Item = &Row> {
        self.setups.iter().flat_map(|setup| &setup.rows)
    }

    /// The printed number of a cell.
    pub fn paper(&self, row: &str, measure: Measure) -> Option<Printed> {
        self.paper.get(row)?.get(&measure).copied()
    }

    /// Fails if the printed numbers and the rows do not match, for example after a misspelt name.
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

    /// Why a cell stands out and what was tried, if known: the text for its row, or else the text for every row.
    pub fn explain(&self, row: &str, measure: Measure) -> Option<&str> {
        let explanation_of = |row: &str| self.explanations.texts.get(row)?.get(&measure);
        explanation_of(row).or_else(|| explanation_of(EVERY_ROW)).map(String::as_str)
    }
}

/// Independent data sets, each with one value for every measure of every row.
pub struct Setup {
    /// Identifier, unique within the experiment.
    pub id: String,
    /// The rows, in the order of the result of [`Trial::run`].
    pub rows: Vec<Row>,
    /// The system, which selects the random stream: setups with equal numbers use equal data sets.
    pub system: u32,
    /// Number of data sets, the first ones; `None` for as many as the experiment has.
    pub data_sets: Option<u32>,
    /// Work of one data set, in any unit that all setups share; used to estimate the remaining time.
    pub cost: u64,
    /// Generates a data set, learns from it and measures the errors.
    pub trial: Box<dyn Trial>,
}

impl Setup {
    /// A setup with as many data sets as its experiment.
    fn new(id: &str, system: u32, cost: u64, rows: Vec<Row>, trial: impl Trial + 'static) -> Setup {
        Setup { id: id.to_owned(), rows, system, data_sets: None, cost, trial: Box::new(trial) }
    }

    /// Number of its data sets in the experiment.
    pub fn data_sets_of(&self, experiment: &Experiment) -> u32 {
        self.data_sets.unwrap_or(experiment.data_sets)
    }

    /// Whether its rows only compare learners with each other.
    pub fn is_of_comparisons(&self) -> bool {
        self.rows.iter().all(|row| row.of == RowOf::Additional)
    }
}

/// One row of a table.
pub struct Row {
    /// Identifier, unique within the experiment.
    pub id: String,
    /// The kind of learner whose errors the row contains.
    pub of: RowOf,
    /// Description of the test samples.
    pub(crate) tested_on: &'static str,
}

impl Row {
    /// A row of a learner's errors in an evaluation.
    fn of_learner(id: &str) -> Row {
        Row { id: id.to_owned(), of: RowOf::Learner, tested_on: TESTED_ON }
    }
}

/// Result of one data set: the measures of each row of its setup.
pub type Measures = Vec<BTreeMap<Measure, f64>>;

/// Everything that a setup does with one data set.
pub trait Trial: Parameters + Send + Sync {
    /// Generates a data set, learns from it and measures the errors, row by row.
    ///
    /// # Errors
    /// If a step fails.
    fn run(&self, rng: &mut ChaCha8Rng) -> anyhow::Result<Measures>;
}

/// All experiments, in the paper's order.
///
/// # Errors
/// If the printed numbers or a robot's file do not match the experiments.
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
