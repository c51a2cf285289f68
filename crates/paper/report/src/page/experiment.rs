//! The section of one experiment: its tables, reservations, figures, and details that the paper leaves open.

use maud::{Markup, html};
use page::{emphasised, key};

use super::table::{columns, grid, is_printed, list, scales, sideways};
use super::verdict_bar::{bar, words};
use super::{Contents, fitted, readings, reservations, view};
use crate::compared::Compared;
use crate::comparisons::Comparisons;
use crate::tally::Tally;

/// The section of an experiment.
pub(super) fn section(compared: &Compared<'_>, contents: &Contents<'_>) -> Markup {
    let experiment = compared.experiment;
    let tally = Tally::of([(compared.experiment, compared.result)]);
    let figures: Vec<_> =
        contents.figures.iter().filter(|(figure, _)| figure.experiment == Some(experiment.id)).collect();
    html! {
        header {
            h2 { (experiment.title) }
            p .where {
                @if experiment.section != "none" { "Section " (experiment.section) " of the paper · " }
                code { (experiment.id) }
            }
            @if tally.total() > 0 { (bar(&tally)) (words(&tally)) }
        }
        @for (row, what) in compared.failures() { p .notice { code { (row) } ": " (what) "." } }
        @if compared.is_printed() {
            (printed(compared)) (reservations::folded(compared, contents))
            @if experiment.id == view::EXPERIMENT { (view::way(contents.sources)) }
            @for (figure, svg) in &figures { (super::card(figure, svg, experiment.title)) }
            (fitted::table(compared)) (comparisons(compared)) (left_open(compared))
        } @else {
            @for (figure, svg) in &figures { (super::card(figure, svg, experiment.title)) }
            (readings::counts(compared)) (comparisons(compared)) (left_open(compared))
            @if compared.rows().next().is_some() { (curves(compared)) }
        }
    }
}

/// The printed cells, with further details folded away.
fn printed(compared: &Compared<'_>) -> Markup {
    let scales = scales(compared);
    let columns = columns(compared);
    html! {
        @match columns {
            Some(columns) => {
                (grid(compared, &columns, &scales))
                (key("the paper’s mean ± s.d."))
                details {
                    summary { "Every cell: median, z, second seed, and what the paper does not print" }
                    (list(compared, &scales, |_| true))
                }
            }
            None => {
                (list(compared, &scales, is_printed))
                (key("the paper’s mean ± s.d."))
                @if compared.lines().any(|line| !is_printed(&line)) {
                    details {
                        summary { "What the paper does not print" }
                        (list(compared, &scales, |line| !is_printed(line)))
                    }
                }
            }
        }
    }
}

/// The numbers behind curves.
fn curves(compared: &Compared<'_>) -> Markup {
    html! {
        details {
            summary { "The numbers behind the curves" }
            (list(compared, &scales(compared), |_| true))
            (key("the paper’s mean ± s.d."))
        }
    }
}

/// Learners side by side, in experiments that compare several.
fn comparisons(compared: &Compared<'_>) -> Markup {
    html! {
        @if let Some(comparisons) = Comparisons::of(compared.experiment, compared.result) {
            h3 { "Learners side by side" }
            p { (emphasised(&comparisons.findings())) " " a href={ "#" (super::learners::ID) } { "The learners" } }
            @if let Some(remark) = comparisons.remark { p { (emphasised(remark)) } }
            (sideways(&format!("Learners side by side: {}", compared.experiment.id), &html! {
                table .comparisons {
                    thead { tr { @for (at, name) in comparisons.header().iter().enumerate() { th scope="col" .number[at > 1] { (name) } } } }
                    tbody {
                        @for row in comparisons.rows() {
                            tr {
                                th scope="row" { (row[0]) }
                                @for (at, cell) in row[1..].iter().enumerate() { td .number[at > 0] { (emphasised(cell)) } }
                            }
                        }
                    }
                }
            }))
        }
    }
}

fn left_open(compared: &Compared<'_>) -> Markup {
    let experiment = compared.experiment;
    html! {
        h3 {
            @if experiment.section == "none" { "How it is set up" } @else { "What the paper leaves open, and what is used here" }
        }
        p {
            (emphasised(experiment.remark))
            " More in " code { "docs/decisions/" (experiment.decisions) } "."
        }
    }
}
