//! The tables of a run beside the paper's, as Markdown.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use crate::experiments::Experiment;
use crate::measure::Measure;
use crate::results::{Cell, ExperimentResult, Results};
use crate::table::markdown_table;
use crate::verdict::Verdict;

/// Standard deviations by which an error must undercut the paper's before the report has to say why.
const REMARKABLY_BETTER: f64 = 2.0;

/// What stands in the columns.
const LEGEND: &str = "\
\"ours\" is the mean ± the sample standard deviation over data sets, \"n\" how many there are, \"paper\" what is printed. \"z\" is the
difference of the two means over its standard error (both spreads count): how sure it is that there is a difference, not how large it is.
An error **agrees** if it is within one printed standard deviation of the printed mean, else it is **better** (lower) or **worse**. A discard
rate agrees within one printed standard deviation (printed 0 ± 0: below .005 %), an error of the naive baseline within two; else they
**differ**.

| measure | is |
| --- | --- |
| potential_nmse | error of the learnt potential (A3) |
| nupe, ncpe | error of the learnt policy, unconstrained (A1) and under the constraints of the demonstrations (A2) |
| naive, policy_align | error of that learner's policy under the constraint of the row |
| alignment_nmse | error of the aligned local potentials (A4) |
| disc | trajectories left out, % |
| unsupported | test samples where no receptive field speaks, % |
| beyond_limits | movements that leave the robot's joint limits somewhere, % |

";

/// Data sets below which single cells are not worth an explanation.
const FEW: usize = 20;

/// All tables of `results`; `second`, a run from another seed, adds its means as a column.
pub(crate) fn markdown(experiments: &[Experiment], results: &Results, second: Option<&Results>) -> String {
    let mut text = LEGEND.to_owned();
    for result in &results.experiments {
        let Some(experiment) = experiments.iter().find(|experiment| experiment.id == result.id) else { continue };
        let second = second.and_then(|second| {
            let result = second.experiments.iter().find(|other| other.id == result.id)?;
            Some((second.seed, result))
        });
        text += &section(experiment, result, results.seed, second);
    }
    text
}

fn section(
    experiment: &Experiment,
    result: &ExperimentResult,
    seed: u64,
    second: Option<(u64, &ExperimentResult)>,
) -> String {
    let mut text = format!("## {} (Section {}): `{}`\n\n", experiment.title, experiment.section, experiment.id);
    let _ = writeln!(text, "{}\n", experiment.remark);
    let _ = writeln!(text, "Seed {seed}. {}\n", tally(result));
    let second_seed = second.map(|(seed, _)| format!("seed {seed}"));
    let mut header = vec!["row", "measure", "ours", "median", "n", "paper", "z", "verdict"];
    header.extend(second_seed.as_deref());
    let mut rows = Vec::new();
    for row in &result.rows {
        for (i, (&measure, cell)) in row.measures.iter().enumerate() {
            let id = if i == 0 { format!("`{}`", row.id) } else { String::new() };
            let n = row.data_sets - row.failed;
            let mut cells = vec![id, measure.name().to_owned()];
            cells.extend(describe(measure, cell, n, experiment.data_sets));
            cells.extend(second.map(|(_, second)| show_second(second, &row.id, measure)));
            rows.push(cells);
        }
        if row.failed > 0 {
            let _ = writeln!(text, "**`{}`: {} of {} data sets failed.**\n", row.id, row.failed, row.data_sets);
        }
    }
    text += &markdown_table(&header, &rows);
    text.push('\n');
    text += &explanations(experiment, result);
    text
}

fn describe(measure: Measure, cell: &Cell, n: usize, paper_n: u32) -> Vec<String> {
    let spread = |sd: Option<f64>| sd.map_or("–".to_owned(), |sd| measure.show(sd));
    let paper = cell.paper.map_or("–".to_owned(), |p| format!("{} ± {}", measure.show(p.mean), measure.show(p.sd)));
    vec![
        format!("{} ± {}", measure.show(cell.mean), spread(cell.sd)),
        measure.show(cell.median),
        n.to_string(),
        paper,
        z(cell, n, paper_n).map_or("–".to_owned(), |z| format!("{z:+.1}")),
        cell.verdict.map_or("–", Verdict::word).to_owned(),
    ]
}

/// Difference of the two means over its standard error.
fn z(cell: &Cell, n: usize, paper_n: u32) -> Option<f64> {
    let paper = cell.paper?;
    let variance = cell.sd?.powi(2) / n as f64 + paper.sd.powi(2) / f64::from(paper_n);
    (variance > 0.0).then(|| (cell.mean - paper.mean) / variance.sqrt())
}

fn show_second(second: &ExperimentResult, row: &str, measure: Measure) -> String {
    let row = second.rows.iter().find(|other| other.id == row);
    let Some(cell) = row.and_then(|row| row.measures.get(&measure)) else { return "–".to_owned() };
    let verdict = cell.verdict.map_or(String::new(), |verdict| format!(" {}", verdict.word()));
    format!("{}{verdict}", measure.show(cell.mean))
}

/// How many cells got which verdict.
pub(crate) fn tally(result: &ExperimentResult) -> String {
    let mut counts: BTreeMap<Verdict, usize> = BTreeMap::new();
    for verdict in result.rows.iter().flat_map(|row| row.measures.values()).filter_map(|cell| cell.verdict) {
        *counts.entry(verdict).or_default() += 1;
    }
    let total: usize = counts.values().sum();
    let word = |verdict: Verdict, count| if count == 1 { verdict.singular() } else { verdict.plural() };
    let words = counts.into_iter().map(|(verdict, count)| format!("{count} {}", word(verdict, count)));
    let words: Vec<String> = words.collect();
    format!("Of {total} printed cells {}.", words.join(", "))
}

fn explanations(experiment: &Experiment, result: &ExperimentResult) -> String {
    let mut text = String::new();
    if result.rows.iter().any(|row| row.data_sets < FEW) {
        return format!("With fewer than {FEW} data sets single cells mean little.\n\n");
    }
    for row in &result.rows {
        for &measure in row.measures.iter().filter(|(_, cell)| needs_a_word(cell)).map(|(measure, _)| measure) {
            let word = experiment.explain(&row.id, measure).unwrap_or("no explanation has been found yet.");
            let _ = writeln!(text, "- `{}`, {}: {word}", row.id, measure.name());
        }
    }
    if text.is_empty() { text } else { format!("What stands out:\n\n{text}\n") }
}

/// Figures that are not reached, and errors that are better by far, must be explained.
fn needs_a_word(cell: &Cell) -> bool {
    let (Some(paper), Some(verdict)) = (cell.paper, cell.verdict) else { return false };
    let far_better = verdict == Verdict::Better && paper.mean - cell.mean > REMARKABLY_BETTER * paper.sd;
    // The baseline's band is twice as wide: what it alone lets pass is worth a word too.
    let barely = verdict == Verdict::Agrees && paper.sd > 0.0 && (cell.mean - paper.mean).abs() > paper.sd;
    !verdict.reached() || far_better || barely
}
