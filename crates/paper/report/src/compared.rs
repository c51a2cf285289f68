//! The texts for each cell: our value beside the paper's and another seed's, the significance of the difference, and why
//! it stands out. The Markdown and the page share them.

use experiments::Experiment;
use experiments::measure::{Measure, RowOf};
use experiments::results::{Cell, ExperimentResult, Results, RowResult};
use experiments::verdict::Verdict;

use super::tally::{STANDARD_ERRORS, z};

/// With fewer data sets, single cells get no explanation.
pub(super) const FEW: usize = 20;

/// Placeholder for an empty cell.
pub(super) const NOTHING: &str = "–";

/// One experiment of a run, compared with the paper and another seed.
pub(super) struct Compared<'a> {
    pub(super) experiment: &'a Experiment,
    pub(super) result: &'a ExperimentResult,
    /// The same experiment from another seed.
    pub(super) second: Option<Second<'a>>,
}

/// The same experiment from another seed.
#[derive(Clone, Copy)]
pub(super) struct Second<'a> {
    pub(super) seed: u64,
    result: &'a ExperimentResult,
}

/// One measure of one row.
#[derive(Clone, Copy)]
pub(super) struct Line<'a> {
    pub(super) row: &'a RowResult,
    pub(super) measure: Measure,
    pub(super) cell: &'a Cell,
    /// The same cell from another seed.
    second: Option<&'a Cell>,
    /// Number of the paper's data sets.
    paper_n: u32,
}

/// Every experiment of the run, in the order of the results.
pub(super) fn compared<'a>(
    experiments: &'a [Experiment],
    results: &'a Results,
    second: Option<&'a Results>,
) -> Vec<Compared<'a>> {
    let beside = |result: &'a ExperimentResult| {
        let second = second.and_then(|second| {
            let result = second.experiment(&result.id)?;
            Some(Second { seed: second.seed, result })
        });
        let experiment = experiments.iter().find(|experiment| experiment.id == result.id)?;
        Some(Compared { experiment, result, second })
    };
    results.experiments.iter().filter_map(beside).collect()
}

impl<'a> Compared<'a> {
    /// Whether the paper prints numbers for the experiment; otherwise it shows curves.
    pub(super) fn is_printed(&self) -> bool {
        !self.experiment.paper.is_empty()
    }

    /// The cells of a row, in the order of the paper's tables.
    pub(super) fn lines_of(&self, row: &'a RowResult) -> impl Iterator<Item = Line<'a>> {
        let second = self.second.and_then(|second| second.result.rows.iter().find(|other| other.id == row.id));
        let paper_n = self.experiment.data_sets;
        let line = move |(&measure, cell)| {
            let second = second.and_then(|row| row.measures.get(&measure));
            Line { row, measure, cell, second, paper_n }
        };
        row.measures.iter().map(line)
    }

    /// The rows of the paper's own learners; the other rows are in the tables of learners.
    pub(super) fn rows(&self) -> impl Iterator<Item = &'a RowResult> {
        let is_additional = |id: &str| self.experiment.rows().any(|row| row.id == id && row.of == RowOf::Additional);
        self.result.rows.iter().filter(move |row| !is_additional(&row.id))
    }

    /// The cells of these rows.
    pub(super) fn lines(&self) -> impl Iterator<Item = Line<'a>> {
        self.rows().flat_map(|row| self.lines_of(row))
    }

    /// Whether there are too few data sets for single cells to mean much.
    pub(super) fn is_glimpse(&self) -> bool {
        self.rows().any(|row| row.data_sets < FEW)
    }

    /// The cells that stand out, with their explanations.
    pub(super) fn standing_out(&self) -> Vec<(Line<'a>, &'a str)> {
        let word = |line: &Line<'_>| self.experiment.explain(&line.row.id, line.measure);
        let lines = self.lines().filter(Line::stands_out);
        lines.map(|line| (line, word(&line).unwrap_or("no explanation has been found yet."))).collect()
    }

    /// Rows in which some data sets failed, with their number.
    pub(super) fn failures(&self) -> impl Iterator<Item = (&'a str, String)> {
        let failed = self.result.rows.iter().filter(|row| row.failed > 0);
        failed.map(|row| (row.id.as_str(), format!("{} of {} data sets failed", row.failed, row.data_sets)))
    }
}

impl Line<'_> {
    /// Whether the verdict is other than "agrees", or the difference is significant.
    fn stands_out(&self) -> bool {
        let is_sure = z(self.cell, self.paper_n).is_some_and(|z| z.abs() > STANDARD_ERRORS);
        self.cell.verdict.is_some_and(|verdict| verdict != Verdict::Agrees || is_sure)
    }

    /// Number of data sets with a value.
    pub(super) fn n(&self) -> usize {
        self.cell.n()
    }

    /// Our mean.
    pub(super) fn mean(&self) -> String {
        self.measure.show(self.cell.mean)
    }

    /// Our standard deviation.
    pub(super) fn spread(&self) -> String {
        self.cell.sd.map_or(NOTHING.to_owned(), |sd| self.measure.show_sd(sd, self.cell.mean))
    }

    /// Our mean ± standard deviation.
    pub(super) fn ours(&self) -> String {
        format!("{}\u{a0}±\u{a0}{}", self.mean(), self.spread())
    }

    /// Our median.
    pub(super) fn median(&self) -> String {
        self.measure.show(self.cell.median)
    }

    /// The printed mean ± standard deviation.
    pub(super) fn paper(&self) -> String {
        let Some(paper) = self.cell.paper else { return NOTHING.to_owned() };
        let (mean, sd) = (self.measure.show_printed(paper.mean), self.measure.show_sd(paper.sd, paper.mean));
        format!("{mean}\u{a0}±\u{a0}{sd}")
    }

    /// Difference of the two means over its standard error.
    pub(super) fn z(&self) -> String {
        z(self.cell, self.paper_n).map_or(NOTHING.to_owned(), |z| format!("{z:+.1}"))
    }

    /// Ratio of our standard deviation to the printed one, if they differ by more than a factor of two.
    pub(super) fn spread_ratio(&self) -> Option<String> {
        let (paper, sd) = self.cell.paper.zip(self.cell.sd)?;
        let ratio = sd / paper.sd;
        (paper.sd > 0.0 && !(0.5..=2.0).contains(&ratio)).then(|| format!("× {ratio:.2}"))
    }

    /// The verdict's word.
    pub(super) fn verdict(&self) -> &'static str {
        self.cell.verdict.map_or(NOTHING, Verdict::word)
    }

    /// The other seed's mean.
    pub(super) fn second(&self) -> String {
        self.second.map_or(NOTHING.to_owned(), |cell| self.measure.show(cell.mean))
    }

    /// The other seed's verdict, if any.
    pub(super) fn second_verdict(&self) -> &'static str {
        self.second.and_then(|cell| cell.verdict).map_or("", Verdict::word)
    }
}

#[cfg(test)]
mod tests {
    use experiments::registry;

    use super::*;

    /// The report explains every printed number of the records that is missed or differs significantly.
    #[test]
    fn outlying_cells_are_explained() {
        let experiments = registry().unwrap();
        for text in [
            include_str!("../../../../docs/records/seed-1/results.json"),
            include_str!("../../../../docs/records/seed-2/results.json"),
        ] {
            let results = Results::read("results.json", text).unwrap();
            for compared in compared(&experiments, &results, None) {
                for line in compared.lines().filter(Line::stands_out) {
                    let said = compared.experiment.explain(&line.row.id, line.measure);
                    assert!(said.is_some(), "{} {} {}", compared.experiment.id, line.row.id, line.measure.name());
                }
            }
        }
    }
}
