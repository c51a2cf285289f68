//! The terminal output at the end of a run: the printed cells, fitted to 80 columns. Everything else is in the report.

use std::fmt::Write as _;

use console::Style;
use experiments::Experiment;
use experiments::results::Results;
use experiments::verdict::Verdict;

use super::compared::{Compared, Line, compared};
use super::comparisons::Comparisons;
use super::tally::Tally;

/// One table per experiment, without colours if the standard output is no terminal or `NO_COLOR` is set.
pub fn terminal(experiments: &[Experiment], results: &Results) -> String {
    compared(experiments, results, None).iter().map(section).collect()
}

fn section(compared: &Compared<'_>) -> String {
    let Compared { experiment, result, .. } = compared;
    let tally = Tally::of([(*experiment, *result)]);
    let title = Style::new().bold().apply_to(experiment.title);
    let mut text = match experiment.section {
        "none" => format!("{title}\n({})\n", experiment.id),
        section => format!("{title}\n(Section {section}; {})\n", experiment.id),
    };
    for (row, what) in compared.failures() {
        let _ = writeln!(text, "  {row}: {what}");
    }
    if tally.total() == 0 {
        let _ = writeln!(text, "  {}\n", counted(compared));
        return text;
    }
    let dim = Style::new().dim();
    let _ = writeln!(text, "{}", dim.apply_to(line("row", "error", ["ours", "paper", "z"], "verdict")));
    for row in compared.rows() {
        let printed = compared.lines_of(row).filter(|line| line.cell.paper.is_some());
        for (i, cell) in printed.enumerate() {
            let name = if i == 0 { row.id.as_str() } else { "" };
            let paper = cell.cell.paper.map_or(String::new(), |paper| cell.measure.show_printed(paper.mean));
            let _ = writeln!(text, "{}", judged(name, &cell, &paper));
        }
    }
    let _ = writeln!(text, "{}\n", tally.sentences().join("\n"));
    text
}

/// A summary of the report on an experiment without printed numbers.
fn counted(compared: &Compared<'_>) -> String {
    let comparisons =
        Comparisons::of(compared.experiment, compared.result).map_or(0, |comparisons| comparisons.lines.len());
    match compared.rows().count() {
        0 => format!("{comparisons} lines of learners side by side: see the report"),
        rows => format!("{rows} rows: see the report"),
    }
}

fn judged(name: &str, cell: &Line<'_>, paper: &str) -> String {
    let verdict =
        cell.cell.verdict.map_or(String::new(), |verdict| colour(verdict).apply_to(verdict.word()).to_string());
    line(name, cell.measure.name(), [&cell.mean(), paper, &cell.z()], &verdict)
}

fn colour(verdict: Verdict) -> Style {
    match verdict {
        Verdict::Agrees => Style::new().green(),
        Verdict::Lower => Style::new().cyan(),
        Verdict::Higher | Verdict::Differs => Style::new().yellow(),
    }
}

/// Formats a line: names on the left, numbers on the right.
fn line(name: &str, measure: &str, numbers: [&str; 3], verdict: &str) -> String {
    let [ours, paper, z] = numbers;
    format!("{name:<25} {measure:<16} {ours:>8} {paper:>8} {z:>6}  {verdict}").trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use console::measure_text_width;
    use experiments::registry;

    use super::*;

    /// Width of the narrowest supported terminal.
    const COLUMNS: usize = 80;

    #[test]
    fn the_committed_tables_fit_a_narrow_terminal() {
        let text = include_str!("../../../../docs/records/seed-1/results.json");
        let results = Results::read("results.json", text).unwrap();
        let text = terminal(&registry().unwrap(), &results);
        let widest = text.lines().max_by_key(|line| measure_text_width(line)).unwrap();
        assert!(measure_text_width(widest) <= COLUMNS, "{widest}");
        assert!(text.contains("sinusoidal-100x100-narrow") && text.contains("agrees"), "{text}");
    }
}
