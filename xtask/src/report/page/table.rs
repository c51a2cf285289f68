//! The tables of an experiment: the paper's own layout where every row has the same measures, and all cells line by line.

use std::collections::BTreeMap;

use maud::{Markup, html};

use super::scale::Scale;
use super::strip::{axis, strip};
use crate::measure::Measure;
use crate::report::compared::{Compared, Line, NOTHING};
use crate::results::RowResult;

/// Rows from which the paper's layout is easier to read than a list.
const MANY_ROWS: usize = 4;

/// One scale for each measure of an experiment.
pub(super) type Scales = BTreeMap<Measure, Scale>;

pub(super) fn scales(compared: &Compared<'_>) -> Scales {
    let measures = compared.lines().map(|line| line.measure);
    let scale = |measure| Scale::around(compared.lines().filter(move |line| line.measure == measure));
    measures.map(|measure| (measure, scale(measure))).collect()
}

/// The measures that are printed in every row, where these are all that is printed.
pub(super) fn columns(compared: &Compared<'_>) -> Option<Vec<Measure>> {
    let printed = |row| compared.lines_of(row).filter(is_printed).map(|line| line.measure).collect::<Vec<_>>();
    let mut rows = compared.result.rows.iter().map(printed);
    let first = rows.next()?;
    (compared.result.rows.len() >= MANY_ROWS && !first.is_empty() && rows.all(|row| row == first)).then_some(first)
}

pub(super) fn is_printed(line: &Line<'_>) -> bool {
    line.cell.paper.is_some()
}

/// As in the paper: a line for each row, a column for each measure.
pub(super) fn grid(compared: &Compared<'_>, columns: &[Measure], scales: &Scales) -> Markup {
    html! {
        table .grid {
            thead {
                tr {
                    th scope="col" { "Row" }
                    @for measure in columns { th scope="col" { (measure.label()) (axis(scales[measure])) } }
                }
            }
            tbody {
                @for row in &compared.result.rows {
                    tr {
                        th scope="row" { (row.id) }
                        @for line in compared.lines_of(row).filter(|line| columns.contains(&line.measure)) {
                            td .{ "is-" (line.verdict()) } data-measure=(line.measure.name()) data-label=(line.measure.label()) {
                                span .ours { (line.ours()) } " " (verdict(&line))
                                span .paper { "paper " (line.paper()) }
                                (strip(&line, scales[&line.measure]))
                            }
                        }
                    }
                }
            }
        }
    }
}

/// A line for each cell that is wanted.
pub(super) fn list(compared: &Compared<'_>, scales: &Scales, wanted: fn(&Line<'_>) -> bool) -> Markup {
    let second = compared.second.map(|second| format!("Seed {}", second.seed));
    html! {
        table .list {
            thead {
                tr {
                    th scope="col" { "Row" }
                    th scope="col" { "Measure" }
                    th scope="col" .number { "Ours" }
                    th scope="col" .number { "Median" }
                    th scope="col" .number { "n" }
                    @if compared.is_printed() {
                        th scope="col" .number { "Paper" }
                        th scope="col" .number { abbr title="difference of the means over its standard error" { "z" } }
                        th scope="col" { "Verdict" }
                    }
                    @if let Some(second) = &second { th scope="col" .number { (second) } }
                    th scope="col" { "Each data set" }
                }
            }
            @for row in &compared.result.rows { (lines(compared, row, scales, wanted)) }
        }
    }
}

fn lines<'a>(compared: &Compared<'a>, row: &'a RowResult, scales: &Scales, wanted: fn(&Line<'_>) -> bool) -> Markup {
    let lines: Vec<Line<'_>> = compared.lines_of(row).filter(wanted).collect();
    let second = compared.second.map(|second| format!("Seed {}", second.seed));
    html! {
        @if !lines.is_empty() {
            tbody data-row=(row.id) {
                @for (i, line) in lines.iter().enumerate() {
                    tr .{ "is-" (word_or(line, "unprinted")) } data-row=(row.id) data-measure=(line.measure.name()) {
                        @if i == 0 { th scope="rowgroup" rowspan=(lines.len()) { (row.id) } }
                        th scope="row" { (line.measure.label()) }
                        td .number data-label="Ours" { (line.ours()) }
                        td .number data-label="Median" { (line.median()) }
                        td .number data-label="n" { (line.n()) }
                        @if compared.is_printed() {
                            td .number data-label="Paper" { (line.paper()) }
                            td .number data-label="z" { (line.z()) }
                            td data-label="Verdict" { (verdict(line)) }
                        }
                        @if let Some(second) = &second { td .number data-label=(second) { (line.second()) } }
                        td .dots data-label="Each data set" { (strip(line, scales[&line.measure])) (axis(scales[&line.measure])) }
                    }
                }
            }
        }
    }
}

fn word_or<'a>(line: &Line<'_>, otherwise: &'a str) -> &'a str {
    if line.cell.verdict.is_some() { line.verdict() } else { otherwise }
}

/// The verdict as a word in its colour.
fn verdict(line: &Line<'_>) -> Markup {
    html! {
        @if line.cell.verdict.is_some() { span .verdict .{ "is-" (line.verdict()) } { (line.verdict()) } }
        @else { (NOTHING) }
    }
}
