//! The tables of a run beside the paper's, as Markdown.

use std::fmt::Write as _;

use super::compared::{Compared, FEW, Line, compared};
use super::legend::{MEASURES, RULE};
use super::tally::Tally;
use crate::experiments::Experiment;
use crate::results::Results;
use crate::table::markdown_table;

/// All tables of `results`; `second`, a run from another seed, adds its means as a column.
pub(crate) fn markdown(experiments: &[Experiment], results: &Results, second: Option<&Results>) -> String {
    let measures = MEASURES.map(|(names, meaning)| format!("| {names} | {meaning} |\n")).concat();
    let mut text = format!("{RULE}\n\n| measure | is |\n| --- | --- |\n{measures}\n");
    for compared in compared(experiments, results, second) {
        text += &section(&compared, results.seed);
    }
    text
}

fn section(compared: &Compared<'_>, seed: u64) -> String {
    let Compared { experiment, result, .. } = compared;
    let mut text = format!("## {} (Section {}): `{}`\n\n", experiment.title, experiment.section, experiment.id);
    let _ = writeln!(text, "{}\n", experiment.remark);
    let _ = writeln!(text, "{}\n", format!("Seed {seed}. {}", Tally::of([*result]).sentence()).trim_end());
    for (row, what) in compared.failures() {
        let _ = writeln!(text, "**`{row}`: {what}.**\n");
    }
    text += &table(compared);
    text.push('\n');
    text += &explanations(compared);
    text
}

/// A column: what stands over it and in it.
type Column<'a> = (String, fn(&Line<'a>) -> String);

fn table<'a>(compared: &Compared<'a>) -> String {
    let column = |name: &str, show: fn(&Line<'a>) -> String| (name.to_owned(), show);
    let mut columns: Vec<Column<'a>> = vec![
        column("measure", |line| line.measure.name().to_owned()),
        column("ours", Line::ours),
        column("median", Line::median),
        column("n", |line| line.n().to_string()),
    ];
    if compared.is_printed() {
        columns.extend([
            column("paper", Line::paper),
            column("z", Line::z),
            column("verdict", |line| line.verdict().to_owned()),
        ]);
    }
    columns.extend(compared.second.map(|second| column(&format!("seed {}", second.seed), Line::second)));
    let header: Vec<&str> = ["row"].into_iter().chain(columns.iter().map(|(name, _)| name.as_str())).collect();
    let mut rows = Vec::new();
    for row in &compared.result.rows {
        for (i, line) in compared.lines_of(row).enumerate() {
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
    if words.is_empty() { words } else { format!("What stands out:\n\n{words}\n") }
}
