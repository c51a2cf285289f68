//! How many printed cells got which verdict.

use std::collections::BTreeMap;

use crate::results::ExperimentResult;
use crate::verdict::Verdict;

/// How many of the printed cells are reached, and how.
pub(crate) struct Tally {
    counts: BTreeMap<Verdict, usize>,
}

impl Tally {
    /// Counts the cells of experiments.
    pub(crate) fn of<'a>(results: impl IntoIterator<Item = &'a ExperimentResult>) -> Tally {
        let mut counts = BTreeMap::new();
        let cells = results.into_iter().flat_map(|result| &result.rows).flat_map(|row| row.measures.values());
        for verdict in cells.filter_map(|cell| cell.verdict) {
            *counts.entry(verdict).or_default() += 1;
        }
        Tally { counts }
    }

    /// Printed cells.
    pub(crate) fn total(&self) -> usize {
        self.counts.values().sum()
    }

    /// The verdicts that there are, from the best known to the worst, with their numbers.
    pub(crate) fn counts(&self) -> impl Iterator<Item = (Verdict, usize)> {
        self.counts.iter().map(|(&verdict, &count)| (verdict, count))
    }

    /// As a sentence; nothing where no cells are printed.
    pub(crate) fn sentence(&self) -> String {
        let words: Vec<String> =
            self.counts().map(|(verdict, count)| format!("{count} {}", after(verdict, count))).collect();
        if words.is_empty() {
            String::new()
        } else {
            format!("Of {} printed cells {}.", self.total(), words.join(", "))
        }
    }
}

/// The verdict as the words after a number of cells.
pub(crate) fn after(verdict: Verdict, count: usize) -> &'static str {
    if count == 1 { verdict.singular() } else { verdict.plural() }
}
