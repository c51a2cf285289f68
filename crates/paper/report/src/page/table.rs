//! The tables of an experiment: the paper's layout if every row has the same measures, and a list of all cells.

use std::collections::BTreeMap;

use experiments::measure::Measure;
use maud::{Markup, html};
use page::{Reference, Scale, Strip, axis};

use crate::compared::{Compared, Line, NOTHING, Second};
use crate::legend::{meaning, term};

/// Number of rows from which the paper's layout is easier to read than a list.
const MANY_ROWS: usize = 4;

/// One scale for each measure of an experiment; the learners of one table share a scale.
pub(super) type Scales = BTreeMap<Measure, Scale>;

/// Errors of learners that are compared side by side.
const SIDE_BY_SIDE: [Measure; 4] = [Measure::Naive, Measure::NaiveAll, Measure::PolicyAlign, Measure::PolicyAlignAll];

pub(super) fn scales(compared: &Compared<'_>) -> Scales {
    let measures = compared.lines().map(|line| line.measure);
    let share = |a, b| a == b || (SIDE_BY_SIDE.contains(&a) && SIDE_BY_SIDE.contains(&b));
    let scale = |measure| {
        let lines: Vec<Line<'_>> = compared.lines().filter(|line| share(line.measure, measure)).collect();
        let values = lines.iter().flat_map(|line| line.cell.values.iter().copied().flatten());
        Scale::around(values, lines.iter().filter_map(reference))
    };
    measures.map(|measure| (measure, scale(measure))).collect()
}

/// The measures that are printed in every row, if every row has the same ones.
pub(super) fn columns(compared: &Compared<'_>) -> Option<Vec<Measure>> {
    let printed = |row| compared.lines_of(row).filter(is_printed).map(|line| line.measure).collect::<Vec<_>>();
    let mut rows = compared.rows().map(printed);
    let first = rows.next()?;
    (compared.rows().count() >= MANY_ROWS && !first.is_empty() && rows.all(|row| row == first)).then_some(first)
}

/// The printed value of a cell.
fn reference(line: &Line<'_>) -> Option<Reference> {
    line.cell.paper.map(|paper| Reference { mean: paper.mean, sd: paper.sd })
}

/// A strip chart of all data sets of a cell.
fn strip(line: &Line<'_>, scale: Scale) -> Markup {
    let show = |value| line.measure.show(value);
    let (mean, median) = (line.cell.mean, line.cell.median);
    Strip { values: &line.cell.values, mean, median, reference: reference(line), show: &show }.drawn(scale)
}

pub(super) fn is_printed(line: &Line<'_>) -> bool {
    line.cell.paper.is_some()
}

/// A table in the paper's layout: a row for each row, a column for each measure.
pub(super) fn grid(compared: &Compared<'_>, columns: &[Measure], scales: &Scales) -> Markup {
    html! {
        table .grid {
            thead {
                tr {
                    th scope="col" { "Row" }
                    @for &measure in columns { th scope="col" { (named(measure)) (axis(scales[&measure])) } }
                }
            }
            tbody {
                @for row in compared.rows() {
                    tr {
                        th scope="row" { (parts(&row.id)) }
                        @for line in compared.lines_of(row).filter(|line| columns.contains(&line.measure)) {
                            td data-row=(row.id) data-measure=(line.measure.name()) {
                                div .judged data-label=(line.measure.label()) { (verdict(&line)) (ours(&line)) }
                                span .minor { "paper " span .paper { (line.paper()) } }
                                (strip(&line, scales[&line.measure]))
                                (axis(scales[&line.measure]))
                            }
                        }
                    }
                }
            }
        }
    }
}

/// A table that scrolls sideways if the page is narrower.
pub(super) fn sideways(label: &str, table: &Markup) -> Markup {
    html! { div .sideways tabindex="0" role="region" aria-label=(label) { (table) } }
}

/// A name with an optional line break after each part; each part shows its meaning as a tooltip.
fn parts(name: &str) -> Markup {
    html! { @for (at, part) in name.split('-').enumerate() { @if at > 0 { "-" wbr; } (explained(part, term(part))) } }
}

/// A measure with its meaning as a tooltip.
fn named(measure: Measure) -> Markup {
    explained(measure.label(), meaning(measure))
}

/// A word with its meaning as a tooltip.
fn explained(word: &str, meaning: Option<&str>) -> Markup {
    html! { @if let Some(meaning) = meaning { abbr title=(meaning) { (word) } } @else { (word) } }
}

/// The columns of a list: with or without the paper's values.
#[derive(Clone, Copy, PartialEq)]
enum Columns {
    BesidePaper,
    Alone,
}

/// A list with a line for each selected cell.
pub(super) fn list(compared: &Compared<'_>, scales: &Scales, wanted: fn(&Line<'_>) -> bool) -> Markup {
    let with_paper = compared.lines().any(|line| wanted(&line) && is_printed(&line));
    let columns = if with_paper { Columns::BesidePaper } else { Columns::Alone };
    html! {
        table .list {
            thead {
                tr {
                    th scope="col" { "Row" }
                    th scope="col" { "Measure" }
                    th scope="col" .number { "Ours" }
                    @if columns == Columns::BesidePaper {
                        th scope="col" .number { "Paper" }
                        th scope="col" { "Verdict" }
                    }
                    @if let Some(second) = compared.second { th scope="col" .number { "Seed " (second.seed) } }
                    th scope="col" { "Each data set" }
                }
            }
            @for row in compared.rows() {
                @let lines: Vec<Line<'_>> = compared.lines_of(row).filter(wanted).collect();
                @if !lines.is_empty() {
                    tbody {
                        @for (i, line) in lines.iter().enumerate() {
                            tr data-row=(row.id) data-measure=(line.measure.name()) {
                                @if i == 0 { th scope="rowgroup" rowspan=(lines.len()) { (parts(&row.id)) } }
                                th scope="row" { (named(line.measure)) }
                                (cells(line, columns))
                                @if let Some(second) = compared.second { (beside(second, line)) }
                                td .dots data-label="Each data set" { (strip(line, scales[&line.measure])) (axis(scales[&line.measure])) }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Our value, and the paper's if `columns` includes it.
fn cells(line: &Line<'_>, columns: Columns) -> Markup {
    html! {
        td .number data-label="Ours" {
            (ours(line))
            span .minor { "median " span .median { (line.median()) } ", n " span .n { (line.n()) } }
        }
        @if columns == Columns::BesidePaper {
            td .number data-label="Paper" {
                span .paper { (line.paper()) }
                @if is_printed(line) { span .minor { "z " span .z { (line.z().replace('-', "−")) } @if let Some(ratio) = line.spread_ratio() { ", s.d. " (ratio) } } }
            }
            td data-label="Verdict" { (verdict(line)) }
        }
    }
}

/// The same cell from another seed.
fn beside(second: Second<'_>, line: &Line<'_>) -> Markup {
    html! {
        td .number data-label={ "Seed " (second.seed) } {
            span .second { (line.second()) }
            span .minor { (line.second_verdict()) }
        }
    }
}

/// Our mean ± standard deviation.
fn ours(line: &Line<'_>) -> Markup {
    html! { span .ours { b { (line.mean()) } "\u{a0}±\u{a0}" (line.spread()) } }
}

/// The verdict as a word in its colour.
fn verdict(line: &Line<'_>) -> Markup {
    html! {
        @if line.cell.verdict.is_some() { span .verdict .{ "is-" (line.verdict()) } { (line.verdict()) } }
        @else { (NOTHING) }
    }
}
