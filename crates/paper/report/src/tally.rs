//! Summary of all comparisons with the printed numbers: factors and verdicts.

use std::collections::BTreeMap;

use experiments::Experiment;
use experiments::results::{Cell, ExperimentResult};
use experiments::verdict::Verdict;

/// Number of standard errors within which two means may well be equal.
pub(super) const STANDARD_ERRORS: f64 = 2.0;

/// Factor up to which two numbers count as close.
const CLOSE: f64 = 1.5;

/// Counts of the printed cells by verdict.
pub struct Tally {
    counts: BTreeMap<Verdict, usize>,
    varying: usize,
    alike: usize,
    /// Factors between our numbers and the printed ones, at least 1, in ascending order; cells where either is 0 are
    /// omitted.
    factors: Vec<f64>,
}

impl Tally {
    /// Counts the cells of experiments.
    pub fn of<'a>(results: impl IntoIterator<Item = (&'a Experiment, &'a ExperimentResult)>) -> Tally {
        let mut tally = Tally { counts: BTreeMap::new(), varying: 0, alike: 0, factors: Vec::new() };
        for (experiment, result) in results {
            for cell in result.rows.iter().flat_map(|row| row.measures.values()) {
                let Some(verdict) = cell.verdict else { continue };
                *tally.counts.entry(verdict).or_default() += 1;
                tally.factors.extend(factor(cell));
                let Some(z) = z(cell, experiment.data_sets) else { continue };
                tally.varying += 1;
                tally.alike += usize::from(z.abs() <= STANDARD_ERRORS);
            }
        }
        tally.factors.sort_by(f64::total_cmp);
        tally
    }

    /// Counts each table once: of a table with two readings, only the literal one counts.
    pub fn of_literal_readings<'a>(results: impl IntoIterator<Item = (&'a Experiment, &'a ExperimentResult)>) -> Tally {
        let results: Vec<_> = results.into_iter().collect();
        let is_read_otherwise = |id: &str| results.iter().any(|(other, _)| other.another_reading_of == Some(id));
        Tally::of(results.iter().copied().filter(|(experiment, _)| !is_read_otherwise(experiment.id)))
    }

    /// Counts each table once: of a table with two readings, only the first one counts.
    pub fn of_first_readings<'a>(results: impl IntoIterator<Item = (&'a Experiment, &'a ExperimentResult)>) -> Tally {
        Tally::of(results.into_iter().filter(|(experiment, _)| experiment.another_reading_of.is_none()))
    }

    /// Number of [`varying`](Self::varying) cells whose means differ by no more than two standard errors.
    pub(crate) fn alike(&self) -> usize {
        self.alike
    }

    /// Number of printed cells with a standard error: the values vary, here or in the paper.
    pub(crate) fn varying(&self) -> usize {
        self.varying
    }

    /// The median factor between our numbers and the printed ones, at least 1; `None` if no cell has a factor.
    pub fn median_factor(&self) -> Option<f64> {
        let (below, above) = (self.factors.len().checked_sub(1)? / 2, self.factors.len() / 2);
        Some(f64::midpoint(self.factors[below], self.factors[above]))
    }

    /// Number of cells within 1.5 times the printed number, and number of cells with a factor.
    pub fn close(&self) -> (usize, usize) {
        (self.factors.iter().filter(|&&factor| factor <= CLOSE).count(), self.factors.len())
    }

    /// Number of printed cells.
    pub fn total(&self) -> usize {
        self.counts.values().sum()
    }

    /// The verdicts that occur, from the best to the worst, with their counts.
    pub(crate) fn counts(&self) -> impl Iterator<Item = (Verdict, usize)> {
        self.counts.iter().map(|(&verdict, &count)| (verdict, count))
    }

    /// "27 agree, 1 is lower".
    pub fn verdicts(&self) -> String {
        let verdicts = self.counts().map(|(verdict, count)| format!("{count} {}", after(verdict, count)));
        verdicts.collect::<Vec<_>>().join(", ")
    }

    /// The factor, the verdicts and their significance, one sentence each; empty if no cells are printed.
    pub fn sentences(&self) -> Vec<String> {
        let mut sentences = Vec::new();
        if let Some(median) = self.median_factor() {
            let (close, all) = self.close();
            sentences
                .push(format!("Median factor to the printed numbers {median:.2}, {close} of {all} within {CLOSE}."));
        }
        if self.total() > 0 {
            let that_vary = if self.varying < self.total() { " that vary" } else { "" };
            sentences.extend([
                format!("Of {} printed cells {}.", self.total(), self.verdicts()),
                format!("Within two standard errors {} of {}{that_vary}.", self.alike, self.varying),
            ]);
        }
        sentences
    }

    /// All [`sentences`](Self::sentences), joined.
    pub fn sentence(&self) -> String {
        self.sentences().join(" ")
    }
}

/// The factor by which our mean and the printed one differ, at least 1.
fn factor(cell: &Cell) -> Option<f64> {
    let ratio = cell.mean / cell.paper?.mean;
    (ratio > 0.0 && ratio.is_finite()).then(|| ratio.max(1.0 / ratio))
}

/// Difference of our mean and the printed one over its standard error; `None` if nothing is printed or nothing varies.
pub(super) fn z(cell: &Cell, paper_n: u32) -> Option<f64> {
    let (paper, sd) = cell.paper.zip(cell.sd)?;
    let variance = sd.powi(2) / cell.n() as f64 + paper.sd.powi(2) / f64::from(paper_n);
    (variance > 0.0).then(|| (cell.mean - paper.mean) / variance.sqrt())
}

/// The verdict, worded to follow a number of cells.
pub(crate) fn after(verdict: Verdict, count: usize) -> &'static str {
    if count == 1 { verdict.singular() } else { verdict.plural() }
}

#[cfg(test)]
mod tests {
    use experiments::paper::Printed;
    use experiments::registry;
    use experiments::results::Results;

    use super::*;

    fn cell(mean: f64, printed: f64) -> Cell {
        let paper = Some(Printed { mean: printed, sd: 0.0 });
        Cell { mean, sd: None, median: mean, values: vec![], paper, verdict: None }
    }

    #[test]
    fn a_factor_does_not_depend_on_which_is_larger() {
        assert_eq!([cell(2.0, 1.0), cell(1.0, 2.0)].map(|cell| factor(&cell)), [Some(2.0); 2]);
        assert_eq!([cell(0.0, 1.0), cell(1.0, 0.0), cell(0.0, 0.0)].map(|cell| factor(&cell)), [None; 3]);
        let tally =
            |factors: &[f64]| Tally { counts: BTreeMap::new(), varying: 0, alike: 0, factors: factors.to_vec() };
        assert_eq!(
            [tally(&[]), tally(&[1.5, 3.0]), tally(&[1.0, 2.0, 7.0])].map(|t| t.median_factor()),
            [None, Some(2.25), Some(2.0)]
        );
        assert_eq!(tally(&[1.0, 1.5, 2.0]).close(), (2, 3));
    }

    /// Each tally counts one reading of Table 1.
    #[test]
    fn both_tallies_count_every_printed_cell_once() {
        let text = include_str!("../../../../docs/records/seed-1/results.json");
        let (experiments, results) = (registry().unwrap(), Results::read("results.json", text).unwrap());
        let mut pairs: Vec<(&Experiment, &ExperimentResult)> = vec![];
        for result in &results.experiments {
            pairs.extend(experiments.iter().filter(|experiment| experiment.id == result.id).map(|e| (e, result)));
        }
        let [fitted, literal] = [Tally::of_first_readings(pairs.clone()), Tally::of_literal_readings(pairs)];
        assert_eq!((fitted.total(), literal.total()), (56, 56));
        assert_ne!(fitted.sentence(), literal.sentence());
    }
}
