//! The opening: what was asked and how it went.

use maud::{Markup, html};
use page::emphasised;

use super::experiment::sentence;
use super::facts::facts;
use super::verdict_bar::{bar, words};
use super::{Contents, OVERVIEW, pictures, view};
use crate::report::compared::{Compared, FEW, Line};
use crate::report::tally::Tally;
use crate::verdict::Verdict;

pub(super) fn opening(contents: &Contents<'_>, all: &[Compared<'_>]) -> Markup {
    let overview = contents.figures.iter().find(|(figure, _)| figure.id == OVERVIEW);
    html! {
        header #glance {
            h1 { "Learn the movement, not the constraint" }
            p .lead {
                "Demonstrations made under constraints that nobody tells, and that change from one to the next, hide the policy behind \
                 them. Howard, Klanke, Gienger, Goerick and Vijayakumar showed how to recover it ("
                cite { "Behaviour Generation in Humanoids by Learning Potential-based Policies from Constrained Motion" }
                "). policy-align computes their experiments anew; this page holds the outcome against what the paper prints."
            }
            (how_it_went(all))
            (facts(contents, all))
            @if all.iter().any(Compared::is_glimpse) {
                p .notice { "With fewer than " (FEW) " data sets a row single numbers mean little." }
            } @else { (not_reached(all)) (pictures::otherwise(contents)) }
        }
        @if let Some((figure, svg)) = overview { (super::card(figure, svg, "")) }
        (view::way(contents.sources))
    }
}

/// How many cells are reached: in total, and for each experiment.
fn how_it_went(all: &[Compared<'_>]) -> Markup {
    let first_readings = all.iter().filter(|compared| compared.experiment.another_reading_of.is_none());
    let total = Tally::of(first_readings.map(|compared| compared.result));
    html! {
        @if total.total() > 0 {
            div .total {
                p .asked { "Of " b { (total.total()) } " numbers that the paper prints" }
                (words(&total))
                (bar(&total))
                p .rule {
                    @for (verdict, _) in total.counts() { (meaning(verdict)) " " }
                    a href="#method" { "The rule in full" }
                }
            }
            table .tallies {
                thead { tr { th scope="col" { "Experiment" } th scope="col" { "Section" } th scope="col" colspan="2" { "Printed numbers" } } }
                tbody { @for compared in all { (tally_of(compared)) } }
            }
        }
    }
}

/// What a verdict says, in short.
fn meaning(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Agrees => {
            "Agree: our mean is within one printed standard deviation of the printed mean (errors of the naive baseline: two)."
        }
        Verdict::Better => "Better: an error of ours below that.",
        Verdict::Worse => "Worse: an error of ours above that.",
        Verdict::Differs => "Differ: a discard rate or an error of the naive baseline outside that.",
    }
}

fn tally_of(compared: &Compared<'_>) -> Markup {
    let experiment = compared.experiment;
    let tally = Tally::of([compared.result]);
    html! {
        @if tally.total() > 0 {
            tr {
                th scope="row" {
                    a href={ "#" (experiment.id) } { (experiment.title) }
                    @if experiment.another_reading_of.is_some() { " (another reading; not in the total)" }
                }
                td { (experiment.section) }
                td { (bar(&tally)) }
                td { (words(&tally)) }
            }
        }
    }
}

/// The cells that are worse than printed or otherwise off, each with what is known of it.
fn not_reached(all: &[Compared<'_>]) -> Markup {
    let (others, first): (Vec<_>, Vec<_>) =
        all.iter().partition(|compared| compared.experiment.another_reading_of.is_some());
    html! {
        (missed("Not reached", &first))
        (missed("Not reached in another reading, which is not in the total", &others))
    }
}

fn missed(heading: &str, among: &[&Compared<'_>]) -> Markup {
    let missed = |line: &Line<'_>| line.cell.verdict.is_some_and(|verdict| !verdict.reached());
    let mut cells = vec![];
    for compared in among {
        cells.extend(compared.lines().filter(missed).map(|line| (compared.experiment, line)));
    }
    html! {
        @if !cells.is_empty() {
            h2 .small { (heading) }
            dl .reasons {
                @for (experiment, line) in cells {
                    div .{ "is-" (line.verdict()) } {
                        dt { a href={ "#" (experiment.id) } { (experiment.title) } ", " code { (line.row.id) } " " (line.measure.label()) }
                        dd {
                            b { (line.ours()) } ", printed " (line.paper()) ". "
                            @if let Some(word) = experiment.explain(&line.row.id, line.measure) { (emphasised(&sentence(word))) }
                        }
                    }
                }
            }
        }
    }
}
