//! Learners held against each other: a line for each error, a column for each learner.

use super::compared::NOTHING;
use crate::experiments::{Contest, Contestant, Experiment};
use crate::measure::Measure;
use crate::results::{Cell, ExperimentResult};

/// A ratio below this is told as "0": it says nothing but that rounding is left.
const NEGLIGIBLE: f64 = 1e-9;

/// The contests of an experiment, as far as they were run.
pub(crate) struct Contests<'a> {
    /// Who has a column.
    pub(crate) contestants: Vec<Contestant>,
    pub(crate) lines: Vec<ContestLine<'a>>,
}

/// One error of several learners, on the data sets that all of them have.
pub(crate) struct ContestLine<'a> {
    pub(crate) contest: &'a Contest,
    pub(crate) n: usize,
    cells: Vec<(Contestant, &'a Cell)>,
}

impl<'a> Contests<'a> {
    /// Nothing where an experiment has none, or none was run.
    pub(crate) fn of(experiment: &'a Experiment, result: &'a ExperimentResult) -> Option<Contests<'a>> {
        let cell = |row: &str, measure: Measure| {
            result.rows.iter().find(|other| other.id == row).and_then(|row| row.measures.get(&measure))
        };
        let line = |contest: &'a Contest| {
            let found = contest.entries.iter();
            let cells: Vec<_> =
                found.filter_map(|entry| Some((entry.contestant, cell(&entry.row, entry.measure)?))).collect();
            let n = cells.iter().map(|(_, cell)| cell.values.len()).min()?;
            cells.iter().any(|(who, _)| *who == Contestant::SlopeGp).then_some(ContestLine { contest, n, cells })
        };
        let lines: Vec<_> = experiment.contests.iter().filter_map(line).collect();
        let takes_part = |who: &Contestant| lines.iter().any(|line| line.mean(*who).is_some());
        let contestants: Vec<_> = Contestant::ALL.into_iter().filter(takes_part).collect();
        (!lines.is_empty()).then_some(Contests { contestants, lines })
    }

    /// What stands over the columns.
    pub(crate) fn header(&self) -> Vec<&'static str> {
        let learners = self.contestants.iter().map(|who| who.label());
        let ratio = self.has_ratio().then_some("slope GP / PolicyAlign");
        ["learnt from", "error of", "n"].into_iter().chain(learners).chain(ratio).collect()
    }

    /// One line a contest: its case, its error, its data sets, each learner's mean, and a ratio of means.
    pub(crate) fn rows(&self) -> Vec<Vec<String>> {
        self.lines.iter().map(|line| self.row(line)).collect()
    }

    fn row(&self, line: &ContestLine<'_>) -> Vec<String> {
        let measure = line.contest.measure;
        let mean = |who: &Contestant| line.mean(*who).map_or(NOTHING.to_owned(), |mean| measure.show(mean));
        let ratio = self.has_ratio().then(|| line.ratio().map_or(NOTHING.to_owned(), shown_ratio));
        let first = [line.contest.case.clone(), measure.label().to_owned(), line.n.to_string()];
        first.into_iter().chain(self.contestants.iter().map(mean)).chain(ratio).collect()
    }

    fn has_ratio(&self) -> bool {
        self.contestants.contains(&Contestant::PolicyAlign)
    }
}

impl ContestLine<'_> {
    /// The mean over the data sets that all have.
    pub(crate) fn mean(&self, who: Contestant) -> Option<f64> {
        let (_, cell) = self.cells.iter().find(|(other, _)| *other == who)?;
        let values: Vec<f64> = cell.values[..self.n].iter().flatten().copied().collect();
        (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
    }

    /// The slope GP's mean over PolicyAlign's.
    fn ratio(&self) -> Option<f64> {
        Some(self.mean(Contestant::SlopeGp)? / self.mean(Contestant::PolicyAlign)?)
    }
}

fn shown_ratio(ratio: f64) -> String {
    match ratio {
        _ if ratio < NEGLIGIBLE => "0".to_owned(),
        _ if ratio < 1e-2 => format!("{ratio:.0e}"),
        _ => format!("{ratio:.2}"),
    }
}

/// What has to be said with such a table.
pub(crate) const CAUTION: &str = "\
Means over the first data sets, the same recordings and test samples for all. \
Parabola, grasp, body and arm have quadratic potentials, which the slope GP's families contain: where the class contains the truth and \
velocities are exact, exact recovery is no feat. The column \"no trend\" is the slope GP without them.";
