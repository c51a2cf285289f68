//! How many printed cells got which verdict.

use std::collections::BTreeMap;

use experiments::Experiment;
use experiments::results::{Cell, ExperimentResult};
use experiments::verdict::Verdict;

/// Standard errors within which two means may well be the same.
const STANDARD_ERRORS: f64 = 2.0;

/// How many of the printed cells are reached, and how.
pub struct Tally {
    counts: BTreeMap<Verdict, usize>,
    varying: usize,
    alike: usize,
}

impl Tally {
    /// Counts the cells of experiments.
    pub fn of<'a>(results: impl IntoIterator<Item = (&'a Experiment, &'a ExperimentResult)>) -> Tally {
        let mut tally = Tally { counts: BTreeMap::new(), varying: 0, alike: 0 };
        for (experiment, result) in results {
            for cell in result.rows.iter().flat_map(|row| row.measures.values()) {
                let Some(verdict) = cell.verdict else { continue };
                *tally.counts.entry(verdict).or_default() += 1;
                let Some(z) = z(cell, experiment.data_sets) else { continue };
                tally.varying += 1;
                tally.alike += usize::from(z.abs() <= STANDARD_ERRORS);
            }
        }
        tally
    }

    /// In all: of another reading of a table no cell counts again.
    pub fn of_first_readings<'a>(results: impl IntoIterator<Item = (&'a Experiment, &'a ExperimentResult)>) -> Tally {
        Tally::of(results.into_iter().filter(|(experiment, _)| experiment.another_reading_of.is_none()))
    }

    /// Of [`varying`](Self::varying) ones, those whose means differ by no more than two standard errors.
    pub(crate) fn alike(&self) -> usize {
        self.alike
    }

    /// Printed cells of which it can be said how sure a difference is: where something varies, here or in the paper.
    pub(crate) fn varying(&self) -> usize {
        self.varying
    }

    /// Printed cells.
    pub fn total(&self) -> usize {
        self.counts.values().sum()
    }

    /// The verdicts that there are, from the best known to the worst, with their numbers.
    pub(crate) fn counts(&self) -> impl Iterator<Item = (Verdict, usize)> {
        self.counts.iter().map(|(&verdict, &count)| (verdict, count))
    }

    /// As a sentence; nothing where no cells are printed.
    pub fn sentence(&self) -> String {
        let words: Vec<String> =
            self.counts().map(|(verdict, count)| format!("{count} {}", after(verdict, count))).collect();
        if words.is_empty() {
            String::new()
        } else {
            let that_vary = if self.varying < self.total() { " that vary" } else { "" };
            let (total, words, alike, varying) = (self.total(), words.join(", "), self.alike, self.varying);
            format!("Of {total} printed cells {words}; within two standard errors {alike} of {varying}{that_vary}.")
        }
    }

    /// [`sentence`](Self::sentence) on two lines, for a terminal of 80 columns.
    pub fn on_two_lines(&self) -> String {
        self.sentence().replace("; ", ";\n")
    }
}

/// Difference of our mean and the printed one over its standard error; none where nothing is printed, or nothing varies.
pub(super) fn z(cell: &Cell, paper_n: u32) -> Option<f64> {
    let (paper, sd) = cell.paper.zip(cell.sd)?;
    let variance = sd.powi(2) / cell.n() as f64 + paper.sd.powi(2) / f64::from(paper_n);
    (variance > 0.0).then(|| (cell.mean - paper.mean) / variance.sqrt())
}

/// The verdict as the words after a number of cells.
pub(crate) fn after(verdict: Verdict, count: usize) -> &'static str {
    if count == 1 { verdict.singular() } else { verdict.plural() }
}
