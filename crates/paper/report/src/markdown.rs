//! The tables of a run compared with the paper's, as Markdown.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use experiments::Experiment;
use experiments::measure::Measure;
use experiments::results::{Results, RowResult};
use experiments::verdict::Verdict;
use page::markdown_table;

use super::compared::{Compared, FEW, Line, compared};
use super::comparisons::{CAUTION, Comparisons};
use super::legend::{MEASURES, RULE, names};
use super::tally::Tally;

/// All tables of `results`; `second`, a run with another seed, adds its means as a column.
pub fn markdown(experiments: &[Experiment], results: &Results, second: Option<&Results>) -> String {
    let all = compared(experiments, results, second);
    let sections: String = all.iter().map(|compared| section(compared, results.seed)).collect();
    format!("{}{sections}", key())
}

/// How to read the tables.
fn key() -> String {
    let measures =
        MEASURES.map(|(measures, meaning)| format!("| {} | {meaning} |\n", names(measures, Measure::name))).concat();
    format!("{RULE}\n\n{CAUTION}\n\n| measure | is |\n| --- | --- |\n{measures}\n")
}

/// An experiment, compared with the paper.
pub struct Section<'a> {
    /// The experiment.
    pub experiment: &'a Experiment,
    /// Its printed cells as Markdown, a line for each row of the paper's table. Each cell has our value and the paper's in
    /// brackets, and the verdict unless they agree.
    pub text: String,
}

/// Short sections of all experiments with printed numbers.
pub fn printed<'a>(experiments: &'a [Experiment], results: &'a Results) -> impl Iterator<Item = Section<'a>> {
    let all = compared(experiments, results, None).into_iter().filter(Compared::is_printed);
    all.map(|compared| Section { experiment: compared.experiment, text: matrix(&compared) })
}

/// The printed cells as a matrix of rows and measures.
fn matrix(compared: &Compared<'_>) -> String {
    let is_printed = |line: &Line<'_>| line.cell.paper.is_some();
    let measures: BTreeSet<Measure> = compared.lines().filter(is_printed).map(|line| line.measure).collect();
    let row = |row: &RowResult| {
        let cell = |measure: &Measure| {
            let line = compared.lines_of(row).filter(is_printed).find(|line| line.measure == *measure);
            line.map_or(String::new(), |line| in_brief(&line))
        };
        [row.id.clone()].into_iter().chain(measures.iter().map(cell)).collect()
    };
    let header: Vec<&str> = ["row"].into_iter().chain(measures.iter().map(|measure| measure.label())).collect();
    markdown_table(&header, &compared.rows().map(row).collect::<Vec<_>>())
}

/// Our value, the paper's in brackets, and the verdict unless they agree.
fn in_brief(line: &Line<'_>) -> String {
    let (ours, paper) =
        (line.mean(), line.cell.paper.map_or(String::new(), |paper| line.measure.show_printed(paper.mean)));
    match line.cell.verdict {
        Some(verdict) if verdict != Verdict::Agrees => format!("**{ours}** ({paper}) {}", verdict.word()),
        _ => format!("{ours} ({paper})"),
    }
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
    text + &comparisons(compared)
}

/// Learners side by side, in experiments that compare several.
fn comparisons(compared: &Compared<'_>) -> String {
    let Some(comparisons) = Comparisons::of(compared.experiment, compared.result) else { return String::new() };
    let remark = comparisons.remark.map_or(String::new(), |remark| format!("{remark}\n\n"));
    folded("Learners side by side", &format!("{}\n\n{remark}{}", comparisons.findings(), comparisons.markdown()))
}

/// A section that the reader must unfold. The empty lines are required for Markdown inside.
fn folded(summary: &str, text: &str) -> String {
    format!("<details><summary>{summary}</summary>\n\n{}\n\n</details>\n\n", text.trim_end())
}

/// A column: its header and the text of each cell.
type Column<'a> = (String, fn(&Line<'a>) -> String);

fn column<'a>(name: &str, show: fn(&Line<'a>) -> String) -> Column<'a> {
    (name.to_owned(), show)
}

/// Columns for comparing a printed cell with the paper, with the verdict.
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

/// All columns of any cell.
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

/// A table of the selected cells, row by row.
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

    fn results(id: &str, row: RowResult) -> Results {
        let result = ExperimentResult { id: id.to_owned(), section: "9".to_owned(), rows: vec![row] };
        let [command, version, rustc, target] = ["", "1", "", ""].map(str::to_owned);
        let (wall_seconds, cpu_seconds, revision) = (1.0, 1.0, None);
        let run = Run { command, threads: 1, resumed: 0, wall_seconds, cpu_seconds, version, revision, rustc, target };
        Results { schema: SCHEMA, seed: 3, quick: false, run, experiments: vec![result] }
    }

    #[test]
    fn short_cells_show_both_values_and_the_verdict() {
        let experiments = registry().unwrap();
        let paper = experiments.iter().find(|experiment| experiment.id == "table1").unwrap();
        let id = "parabola-40x40-narrow";
        let cell = |measure, mean, verdict| {
            let paper = paper.paper(id, measure);
            (measure, Cell { mean, sd: None, median: mean, values: vec![Some(mean)], paper, verdict })
        };
        let cells = [
            cell(Measure::Nupe, 0.02, Some(Verdict::Lower)),
            cell(Measure::Ncpe, 0.024, Some(Verdict::Agrees)),
            cell(Measure::NupeFresh, 0.1, None),
        ];
        let row =
            RowResult { id: id.to_owned(), tested_on: String::new(), data_sets: 1, failed: 0, measures: cells.into() };
        let results = results("table1", row);
        let texts: Vec<String> = printed(&experiments, &results).map(|section| section.text).collect();
        let expected = "| row | nUPE | nCPE |\n| --- | --- | --- |\n\
                        | parabola-40x40-narrow | **0.0200** (0.0486) lower | 0.0240 (0.0235) |\n";
        assert_eq!(texts, [expected]);
    }

    #[test]
    fn curve_sections_omit_columns_of_printed_numbers() {
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
        let results = results(curves.id, row);
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
            "| row | measure | ours | median | n |",
            "| --- | --- | --- | --- | --- |",
            "| `a-row` | nupe | 0.2500\u{a0}±\u{a0}0.1250 | 0.5000 | 2 |",
            "</details>",
            "With fewer than 20 data sets single cells mean little.",
        ];
        assert_eq!(lines, expected);
    }
}
