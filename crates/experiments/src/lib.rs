//! The registry: every table and figure of the paper that can be reproduced, one file each.

mod asimo22;
mod beside;
mod beyond;
mod constraint_consistent;
mod contest;
mod exam;
mod figure6;
mod figure9;
mod fresh;
mod gaussians;
mod judge;
mod parameters;
mod pupil;
mod readings;
mod seen;
mod settings;
mod table1;
mod table2;
mod test_samples;
mod three_link;

pub(crate) use beyond::case_on_the_plane;
pub(crate) use contest::{Contest, Contestant};
pub(crate) use figure6::{BANDWIDTHS, BESIDE_LEFT, BESIDE_RIGHT, NOISE_PERCENT, RULES, TRAJECTORIES_PERCENT};
pub(crate) use figure9::{Distance, TENTHS, line};
pub(crate) use judge::Judge;
pub(crate) use parameters::Parameters;
pub(crate) use settings::{Setting, quotable, settings};
pub(crate) use table1::{PARABOLA_SYSTEM, SINUSOIDAL_SYSTEM, toy_beside, toy_regressor};
pub(crate) use table2::{GRASP_SYSTEM, grasp, grasp_beside, grasp_naive, grasp_regressor};
pub(crate) use test_samples::TestSamples;
pub(crate) use three_link::{ARM_SYSTEM, arm};

use std::collections::BTreeMap;

use anyhow::ensure;
use rand_chacha::ChaCha8Rng;

use exam::TESTED_ON;

use crate::measure::{Measure, RowOf};
use crate::paper::{Explanations, PaperTable, Printed};

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
    /// The page of `docs/decisions` on why it is done so.
    pub(crate) decisions: &'static str,
    /// The experiment of which it is another reading: its cells are no further figures of the paper.
    pub(crate) another_reading_of: Option<&'static str>,
    /// What has to be said beside the table of learners.
    pub(crate) contests_remark: Option<&'static str>,
    /// Learners held against each other, a line for each error; empty where there is one learner alone.
    pub(crate) contests: Vec<Contest>,
    /// What is measured, in the table's order.
    pub(crate) setups: Vec<Setup>,
    /// The printed figures: `xtask/paper/*.toml`; empty where the paper shows curves only.
    pub(crate) paper: PaperTable,
    /// Why single cells stand out: `xtask/paper/*-explained.toml`.
    pub(crate) explanations: Explanations,
}

impl Experiment {
    /// All rows, in the table's order.
    pub(crate) fn rows(&self) -> impl Iterator<Item = &Row> {
        self.setups.iter().flat_map(|setup| &setup.rows)
    }

    /// The printed figure of a cell.
    pub(crate) fn paper(&self, row: &str, measure: Measure) -> Option<Printed> {
        self.paper.get(row)?.get(&measure).copied()
    }

    /// Fails if the printed figures and the rows do not belong together, as after a slip in a name.
    fn checked(self) -> anyhow::Result<Self> {
        let of_paper = |row: &&Row| !self.paper.is_empty() && row.of != RowOf::Contestant;
        for row in self.rows().filter(of_paper) {
            ensure!(self.paper.contains_key(&row.id), "{}: xtask/paper has no row {}", self.id, row.id);
        }
        for id in self.paper.keys().chain(self.explanations.texts.keys()) {
            ensure!(self.rows().any(|row| row.id == *id), "{}: xtask/paper has a row {id} that is not run", self.id);
        }
        for entry in self.contests.iter().flat_map(|contest| &contest.entries) {
            let (id, row) = (self.id, &entry.row);
            ensure!(self.rows().any(|other| other.id == *row), "{id}: a contest has a row {row} that is not run");
        }
        Ok(self)
    }

    /// Why a cell stands out, if that is known.
    pub(crate) fn explain(&self, row: &str, measure: Measure) -> Option<&str> {
        self.explanations.texts.get(row)?.get(&measure).map(String::as_str)
    }
}

/// Independent data sets, each of which gives one value for every measure of every row.
pub(crate) struct Setup {
    /// Identifier, unique within the experiment.
    pub(crate) id: String,
    /// The rows, in the order of what [`Trial::run`] returns.
    pub(crate) rows: Vec<Row>,
    /// The system whose random stream is used: equal numbers see equal data sets.
    pub(crate) system: u32,
    /// How many data sets it sees, where not as many as the experiment has: then the first ones.
    pub(crate) data_sets: Option<u32>,
    /// Work of one data set, in any unit that all setups share; used for the time left.
    pub(crate) cost: u64,
    /// How a data set is made, learnt and scored.
    pub(crate) trial: Box<dyn Trial>,
}

impl Setup {
    /// How many data sets it sees in its experiment.
    pub(crate) fn data_sets_of(&self, experiment: &Experiment) -> u32 {
        self.data_sets.unwrap_or(experiment.data_sets)
    }

    /// Whether its rows only hold learners against each other.
    pub(crate) fn is_of_contestants(&self) -> bool {
        self.rows.iter().all(|row| row.of == RowOf::Contestant)
    }
}

/// One row of a table.
pub(crate) struct Row {
    /// Identifier, unique within the experiment.
    pub(crate) id: String,
    /// Whose errors stand in it.
    pub(crate) of: RowOf,
    /// Which samples its errors are of.
    pub(crate) tested_on: &'static str,
}

impl Row {
    /// A row of a learner's errors in an exam.
    fn of_learner(id: &str) -> Row {
        Row { id: id.to_owned(), of: RowOf::Learner, tested_on: TESTED_ON }
    }
}

/// What one data set gives: the measures of each row of its setup.
pub(crate) type Measures = Vec<BTreeMap<Measure, f64>>;

/// Everything that one data set of a setup needs.
pub(crate) trait Trial: Parameters + Send + Sync {
    /// Makes a data set, learns from it and scores what was learnt, row by row.
    fn run(&self, rng: &mut ChaCha8Rng) -> anyhow::Result<Measures>;
}

/// All experiments, in the paper's order.
pub(crate) fn registry() -> anyhow::Result<Vec<Experiment>> {
    let experiments = [
        table1::table1()?,
        table1::table1_literal()?,
        figure6::figure6_left(),
        figure6::figure6_right(),
        table2::table2()?,
        asimo22::asimo22()?,
        three_link::three_link()?,
        figure9::figure9()?,
        beyond::beyond(),
        readings::readings(),
    ];
    experiments.into_iter().map(Experiment::checked).collect()
}
