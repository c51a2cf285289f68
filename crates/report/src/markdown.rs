//! The tables of a run beside the paper's, as Markdown.

use std::fmt::Write as _;

use experiments::Experiment;
use experiments::measure::Measure;
use experiments::results::Results;
use page::markdown_table;

use super::compared::{Compared, FEW, Line, compared};
use super::contests::{CAUTION, Contests};
use super::legend::{MEASURES, RULE, names};
use super::tally::Tally;

/// All tables of `results`; `second`, a run from another seed, adds its means as a column.
pub fn markdown(experiments: &[Experiment], results: &Results, second: Option<&Results>) -> String {
    let sections = sections(experiments, results, second).map(|section| section.text);
    format!("{}{}", key(), sections.collect::<String>())
}

/// How to read the tables.
pub fn key() -> String {
    let measures =
        MEASURES.map(|(measures, meaning)| format!("| {} | {meaning} |\n", names(measures, Measure::name))).concat();
    format!("{RULE}\n\n{CAUTION}\n\n| measure | is |\n| --- | --- |\n{measures}\n")
}

/// An experiment with its tables.
pub struct Section<'a> {
    /// Which.
    pub experiment: &'a Experiment,
    /// As Markdown.
    pub text: String,
}

/// What there is on each experiment.
pub fn sections<'a>(
    experiments: &'a [Experiment],
    results: &'a Results,
    second: Option<&'a Results>,
) -> impl Iterator<Item = Section<'a>> {
    let all = compared(experiments, results, second).into_iter();
    all.map(|compared| Section { experiment: compared.experiment, text: section(&compared, results.seed) })
}

fn title(experiment: &Experiment) -> String {
    match experiment.section {
        "none" => format!("{}: `{}`", experiment.title, experiment.id),
        section => format!("{} (Section {section}): `{}`", experiment.title, experiment.id),
    }
}

fn section(compared: &Compared<'_>, seed: u64) -> String {
    let Compared { experiment, result, .. } = compared;
    let mut text = format!("## {}\n\n", title(experiment));
    let _ =
        writeln!(text, "{}\n", format!("Seed {seed}. {}", Tally::of([(*experiment, *result)]).sentence()).trim_end());
    text += &folded("How it was set up, and what is fitted", experiment.remark);
    for (row, what) in compared.failures() {
        let _ = writeln!(text, "**`{row}`: {what}.**\n");
    }
    if compared.is_printed() {
        let _ = writeln!(text, "{}", table(compared, &judged(), |line| line.cell.paper.is_some()));
    }
    if let Some(n) = Some(compared.lines().count()).filter(|&n| n > 0) {
        text += &folded(&format!("All {n} means"), &table(compared, &in_full(compared), |_| true));
        text += &explanations(compared);
    }
    text + &contests(compared)
}

/// Learners side by side, where there are several.
fn contests(compared: &Compared<'_>) -> String {
    let Some(contests) = Contests::of(compared.experiment, compared.result) else { return String::new() };
    let remark = contests.remark.map_or(String::new(), |remark| format!("{remark}\n\n"));
    folded("Learners side by side", &format!("{}\n\n{remark}{}", contests.findings(), contests.markdown()))
}

/// What is seen only by who opens it. Markdown within needs the empty lines.
pub fn folded(summary: &str, text: &str) -> String {
    format!("<details><summary>{summary}</summary>\n\n{}\n\n</details>\n\n", text.trim_end())
}

/// A column: what stands over it and in it.
type Column<'a> = (String, fn(&Line<'a>) -> String);

fn column<'a>(name: &str, show: fn(&Line<'a>) -> String) -> Column<'a> {
    (name.to_owned(), show)
}

/// What a printed cell is held against, and how it comes out.
fn judged<'a>() -> Vec<Column<'a>> {
    vec![
        column("measure", |line| line.measure.name().to_owned()),
        column("ours", Line::ours),
        column("paper", Line::paper),
        column("s.d.", |line| line.spread_ratio().unwrap_or_default()),
        column("z", Line::z),
        column("verdict", |line| line.verdict().to_owned()),
    ]
}

/// All there is to know of any cell.
fn in_full<'a>(compared: &Compared<'a>) -> Vec<Column<'a>> {
    let mut columns = vec![
        column("measure", |line| line.measure.name().to_owned()),
        column("ours", Line::ours),
        column("median", Line::median),
        column("n", |line| line.n().to_string()),
    ];
    if compared.is_printed() {
        columns.extend([column("paper", Line::paper), column("s.d.", |line| line.spread_ratio().unwrap_or_default())]);
    }
    let second: fn(&Line<'a>) -> String =
        |line| format!("{} {}", line.second(), line.second_verdict()).trim_end().to_owned();
    columns.extend(compared.second.map(|other| column(&format!("seed {}", other.seed), second)));
    columns
}

/// The wanted cells, row by row.
fn table<'a>(compared: &Compared<'a>, columns: &[Column<'a>], wanted: fn(&Line<'a>) -> bool) -> String {
    let header: Vec<&str> = ["row"].into_iter().chain(columns.iter().map(|(name, _)| name.as_str())).collect();
    let mut rows = Vec::new();
    for row in compared.rows() {
        for (i, line) in compared.lines_of(row).filter(wanted).enumerate() {
            let id = if i == 0 { format!("`{}`", row.id) } else { String::new() };
            rows.push([id].into_iter().chain(columns.iter().map(|(_, show)| show(&line))).collect());
        }
    }
    markdown_table(&header, &rows)
}

fn explanations(compared: &Compared<'_>) -> String {
    if compared.is_glimpse() {
        return format!("With fewer than {FEW} data sets single cells mean little.\n\n");
    }
    let word = |(line, word): &(Line<'_>, &str)| format!("- `{}`, {}: {word}\n", line.row.id, line.measure.name());
    let words: String = compared.standing_out().iter().map(word).collect();
    let what = "What stands out, and why (numbers quoted are of the full run of seed 1)";
    if words.is_empty() { words } else { folded(what, &words) }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use experiments::measure::Measure;
    use experiments::registry;
    use experiments::results::{Cell, ExperimentResult, RowResult, Run, SCHEMA};

    use super::*;

    #[test]
    fn what_the_paper_shows_as_curves_has_no_columns_for_printed_figures() {
        let experiments = registry().unwrap();
        let curves = experiments.iter().find(|experiment| experiment.paper.is_empty()).unwrap();
        let cell = Cell {
            mean: 0.25,
            sd: Some(0.125),
            median: 0.5,
            values: vec![Some(0.25), None, Some(0.5)],
            paper: None,
            verdict: None,
        };
        let measures = BTreeMap::from([(Measure::Nupe, cell)]);
        let row = RowResult { id: "a-row".to_owned(), tested_on: String::new(), data_sets: 3, failed: 1, measures };
        let result = ExperimentResult { id: curves.id.to_owned(), section: "9".to_owned(), rows: vec![row] };
        let [command, version, rustc, target] = ["", "1", "", ""].map(str::to_owned);
        let (wall_seconds, cpu_seconds, revision) = (1.0, 1.0, None);
        let run = Run { command, threads: 1, resumed: 0, wall_seconds, cpu_seconds, version, revision, rustc, target };
        let results = Results { schema: SCHEMA, seed: 3, quick: false, run, experiments: vec![result] };
        let text = markdown(&experiments, &results, None);
        let (_, section) = text.split_once("## ").unwrap();
        let lines: Vec<&str> = section.lines().filter(|line| !line.is_empty()).skip(1).collect();
        let expected = [
            "Seed 3.",
            "<details><summary>How it was set up, and what is fitted</summary>",
            curves.remark,
            "</details>",
            "**`a-row`: 1 of 3 data sets failed.**",
            "<details><summary>All 1 means</summary>",
            "| row     | measure | ours            | median | n |",
            "| ------- | ------- | --------------- | ------ | - |",
            "| `a-row` | nupe    | 0.2500\u{a0}±\u{a0}0.1250 | 0.5000 | 2 |",
            "</details>",
            "With fewer than 20 data sets single cells mean little.",
        ];
        assert_eq!(lines, expected);
    }
}
