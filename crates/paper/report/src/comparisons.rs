//! Learners compared: a line for each error, a column for each learner.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use experiments::measure::Measure;
use experiments::results::{Cell, ExperimentResult};
use experiments::variants::two_digits;
use experiments::{Comparison, Experiment, Method};
use page::markdown_table;

use super::compared::NOTHING;

/// Up to this many lines are named individually.
const FEW: usize = 5;

/// A ratio below this is shown as "0", because it reflects only rounding errors.
const NEGLIGIBLE: f64 = 1e-9;

/// The comparisons of an experiment, as far as the run includes them.
pub(crate) struct Comparisons<'a> {
    /// A remark about these comparisons.
    pub(crate) remark: Option<&'static str>,
    /// The learners, one column each.
    pub(crate) methods: Vec<Method>,
    pub(crate) lines: Vec<ComparisonLine<'a>>,
}

/// One error of several learners, on the data sets that all of them share.
pub(crate) struct ComparisonLine<'a> {
    pub(crate) comparison: &'a Comparison,
    pub(crate) n: usize,
    cells: Vec<(Method, &'a Cell)>,
}

impl<'a> Comparisons<'a> {
    /// Returns `None` if an experiment has no comparisons, or none was run.
    pub(crate) fn of(experiment: &'a Experiment, result: &'a ExperimentResult) -> Option<Comparisons<'a>> {
        let cell = |row: &str, measure: Measure| {
            result.rows.iter().find(|other| other.id == row).and_then(|row| row.measures.get(&measure))
        };
        let line = |comparison: &'a Comparison| {
            let found = comparison.entries.iter();
            let cells: Vec<_> =
                found.filter_map(|entry| Some((entry.method, cell(&entry.row, entry.measure)?))).collect();
            let n = cells.iter().map(|(_, cell)| cell.values.len()).min()?;
            cells.iter().any(|(method, _)| *method == Method::SlopeGp).then_some(ComparisonLine {
                comparison,
                n,
                cells,
            })
        };
        let lines: Vec<_> = experiment.comparisons.iter().filter_map(line).collect();
        let takes_part = |method: &Method| lines.iter().any(|line| line.mean(*method).is_some());
        let methods: Vec<_> = Method::ALL.into_iter().filter(takes_part).collect();
        (!lines.is_empty()).then_some(Comparisons { remark: experiment.comparisons_remark, methods, lines })
    }

    /// The comparisons as a Markdown table.
    pub(crate) fn markdown(&self) -> String {
        markdown_table(&self.header(), &self.rows())
    }

    /// The column headers.
    pub(crate) fn header(&self) -> Vec<&'static str> {
        let learners = self.methods.iter().map(|method| method.label());
        let ratio = self.has_ratio().then_some("slope GP / PolicyAlign");
        ["learnt from", "error of", "n"].into_iter().chain(learners).chain(ratio).collect()
    }

    /// One row per comparison: its case, its error, its number of data sets, each learner's mean (the least emphasised), and a
    /// ratio of means.
    pub(crate) fn rows(&self) -> Vec<Vec<String>> {
        self.lines.iter().map(|line| self.row(line)).collect()
    }

    fn row(&self, line: &ComparisonLine<'_>) -> Vec<String> {
        let measure = line.comparison.measure;
        let least = self.methods.iter().filter_map(|method| line.mean(*method)).fold(f64::INFINITY, f64::min);
        let mean = |method: &Method| match line.mean(*method) {
            None => NOTHING.to_owned(),
            Some(mean) if mean == least => format!("**{}**", shown_mean(mean)),
            Some(mean) => shown_mean(mean),
        };
        let ratio = self.has_ratio().then(|| line.ratio().map_or(NOTHING.to_owned(), shown_ratio));
        let first = [line.comparison.case.clone(), measure.label().to_owned(), line.n.to_string()];
        first.into_iter().chain(self.methods.iter().map(mean)).chain(ratio).collect()
    }

    /// Which learners err least, and where PolicyAlign errs more than another method of its time.
    pub(crate) fn findings(&self) -> String {
        let mut least: BTreeMap<Method, usize> = BTreeMap::new();
        for line in &self.lines {
            *least.entry(line.least()).or_default() += 1;
        }
        let mut ranked: Vec<(Method, usize)> = least.into_iter().collect();
        ranked.sort_by_key(|&(_, times)| std::cmp::Reverse(times));
        let mut text = String::new();
        for (at, (method, times)) in ranked.iter().enumerate() {
            let method = method.label();
            let _ = match at {
                0 => write!(text, "Of {} comparisons, {method} has the least error in {times}", self.lines.len()),
                _ => write!(text, ", {method} in {times}"),
            };
        }
        text.push('.');
        for (method, name) in [(Method::Naive, "The naive learner"), (Method::ConstraintConsistent, "Radial basis")] {
            let ahead: Vec<String> = self
                .lines
                .iter()
                .filter(|line| line.is_ahead_of_policy_align(method))
                .map(ComparisonLine::name)
                .collect();
            let named = if ahead.len() <= FEW { format!(": {}", ahead.join(", ")) } else { String::new() };
            if !ahead.is_empty() {
                let _ = write!(text, " {name} errs less than PolicyAlign in {}{named}.", ahead.len());
            }
        }
        text
    }

    fn has_ratio(&self) -> bool {
        self.methods.contains(&Method::PolicyAlign)
    }
}

impl ComparisonLine<'_> {
    /// The mean over the data sets that all learners share.
    pub(crate) fn mean(&self, method: Method) -> Option<f64> {
        let (_, cell) = self.cells.iter().find(|(other, _)| *other == method)?;
        let values: Vec<f64> = cell.values[..self.n].iter().flatten().copied().collect();
        (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
    }

    /// The learner with the smallest mean; "automatic" and "no trend" do not count as learners.
    pub(crate) fn least(&self) -> Method {
        let means = self.cells.iter().filter(|(method, _)| !matches!(method, Method::AutoGp | Method::SlopeGpNoTrend));
        let means = means.filter_map(|(method, _)| Some((*method, self.mean(*method)?)));
        let least = means.min_by(|(_, a), (_, b)| a.total_cmp(b));
        least.map_or(Method::SlopeGp, |(method, _)| method)
    }

    pub(crate) fn is_ahead_of_policy_align(&self, method: Method) -> bool {
        self.mean(method)
            .zip(self.mean(Method::PolicyAlign))
            .is_some_and(|(method, policy_align)| method < policy_align)
    }

    /// The case and the error.
    fn name(&self) -> String {
        format!("`{}` {}", self.comparison.case, self.comparison.measure.label())
    }

    /// The slope GP's mean over PolicyAlign's.
    fn ratio(&self) -> Option<f64> {
        Some(self.mean(Method::SlopeGp)? / self.mean(Method::PolicyAlign)?)
    }
}

/// Formats a mean: two significant digits, or for small means one digit and the exponent, because the errors of these
/// learners differ by orders of magnitude.
pub(crate) fn shown_mean(mean: f64) -> String {
    match mean {
        0.0 => "0".to_owned(),
        _ if mean.abs() < 1e-3 => format!("{mean:.0e}"),
        _ => two_digits(mean),
    }
}

fn shown_ratio(ratio: f64) -> String {
    match ratio {
        _ if ratio < NEGLIGIBLE => format!("< {NEGLIGIBLE:.0e}"),
        _ if ratio < 1e-2 => format!("{ratio:.0e}"),
        _ => format!("{ratio:.2}"),
    }
}

/// A caution about such tables.
pub(crate) const CAUTION: &str = "\
In comparisons of learners, numbers are means over the first n data sets, fewer than in the paper's tables (errors of data sets differ by factors of \
up to a thousand). All learners get the same recordings and test samples. Parabola, grasp, body and arm have quadratic potentials, which the slope GP's \
families contain: with exact velocities, exact recovery is expected. The column \"no trend\" leaves those families out. Bold marks the least error. \
Wins are counted per learner; the variants \"no trend\" and \"automatic\" do not count separately.";

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use experiments::registry;
    use experiments::results::RowResult;

    use super::*;

    fn row(id: &str, values: &[Option<f64>]) -> RowResult {
        let known: Vec<f64> = values.iter().flatten().copied().collect();
        let mean = known.iter().sum::<f64>() / known.len() as f64;
        let cell = Cell { mean, sd: None, median: mean, values: values.to_vec(), paper: None, verdict: None };
        let measures = BTreeMap::from([(Measure::Nupe, cell)]);
        RowResult { id: id.to_owned(), tested_on: String::new(), data_sets: values.len(), failed: 0, measures }
    }

    /// PolicyAlign has more data sets than the others: only the first ones count. A set that is missing for one learner still
    /// counts for the others.
    #[test]
    fn means_use_only_common_data_sets() {
        let experiments = registry().unwrap();
        let table1 = experiments.iter().find(|experiment| experiment.id == "table1").unwrap();
        let case = "parabola-40x40-narrow";
        let rows = vec![
            row(case, &[Some(0.1), Some(0.3), Some(9.0)]),
            row(&format!("{case}/slope_gp"), &[Some(0.001), Some(0.003)]),
            row(&format!("{case}/naive"), &[None, Some(0.5)]),
        ];
        let result = ExperimentResult { id: "table1".to_owned(), section: "4.1".to_owned(), rows };
        let comparisons = Comparisons::of(table1, &result).unwrap();
        assert_eq!(comparisons.methods, [Method::Naive, Method::PolicyAlign, Method::SlopeGp]);
        let findings = "Of 1 comparisons, slope GP has the least error in 1.";
        assert_eq!(comparisons.findings(), findings);
        let expected = [case, "nUPE", "2", "0.50", "0.20", "**0.0020**", "0.01"];
        assert_eq!(comparisons.rows(), [expected.map(str::to_owned).to_vec()]);
        assert_eq!(comparisons.header().len(), expected.len());
    }

    #[test]
    fn no_table_is_made_without_the_slope_gp() {
        let experiments = registry().unwrap();
        let table1 = experiments.iter().find(|experiment| experiment.id == "table1").unwrap();
        let rows = vec![row("parabola-40x40-narrow", &[Some(0.1)])];
        let result = ExperimentResult { id: "table1".to_owned(), section: "4.1".to_owned(), rows };
        assert!(Comparisons::of(table1, &result).is_none());
    }

    #[test]
    fn small_errors_are_shown_by_their_exponents() {
        let shown = [0.2, 0.000_762, 3e-21, 0.0, 957.6].map(shown_mean);
        assert_eq!(shown, ["0.20", "8e-4", "3e-21", "0", "958"]);
    }

    #[test]
    fn ratios_are_shown_with_suitable_precision() {
        assert_eq!([2.5, 0.004, 3e-21].map(shown_ratio), ["2.50", "4e-3", "< 1e-9"]);
    }
}
