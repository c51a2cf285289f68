//! The opening: what was asked and how it went.

use experiments::verdict::Verdict;
use maud::{Markup, html};
use page::emphasised;

use super::experiment::sentence;
use super::facts::facts;
use super::verdict_bar::{bar, words};
use super::{Contents, OVERVIEW, pictures, view};
use crate::compared::{Compared, FEW, Line};
use crate::tally::Tally;

pub(super) fn opening(contents: &Contents<'_>, all: &[Compared<'_>]) -> Markup {
    let tally = Tally::of_first_readings(all.iter().map(|compared| (compared.experiment, compared.result)));
    let overview = contents.figures.iter().find(|(figure, _)| figure.id == OVERVIEW);
    html! {
        header #glance {
            h1 { "Learn the movement, not the constraint" }
            div .first {
                // In this order on a phone: the picture before the numbers.
                p .lead {
                    "Demonstrations are made under unknown, changing constraints, which hide the policy. Howard, Klanke, Gienger, Goerick and Vijayakumar showed how to recover it ("
                    cite { "Behaviour Generation in Humanoids by Learning Potential-based Policies from Constrained Motion" }
                    "). policy-align repeats their experiments; this page compares our results with the paper's numbers."
                }
                @if let Some((figure, svg)) = overview { (super::card(figure, svg, "")) }
                (total(&tally))
            }
            (how_it_went(&tally, all))
            (facts(contents, all))
            @if all.iter().any(Compared::is_glimpse) {
                p .notice { "With fewer than " (FEW) " data sets a row single numbers mean little." }
            } @else { (not_reached(all)) (pictures::otherwise(contents)) }
        }
        (view::way(contents.sources))
    }
}

/// What is not the paper's; each experiment names its own.
const FITTED: &str = "What the paper does not give was fitted, so that its numbers come out: how often a toy constraint is drawn anew (every 20 \
                      samples; twice a movement is the text read literally); where ball, wall and obstacle are, and how the robot stands \
                      (Table 2); the 22 joints' posture and attractor; and the regression's widths and passes, one setting for each learner of \
                      an experiment. Each experiment names its own.";

/// How many cells are reached in total, and how sure that is.
fn total(total: &Tally) -> Markup {
    html! {
        @if total.total() > 0 {
            div .total {
                p .asked { "Of " b { (total.total()) } " numbers that the paper prints" }
                (words(total))
                (bar(total))
                p {
                    "How sure that is: " b { (total.alike()) } " of the " (total.total()) " means are within two standard errors of the printed \
                     ones; the others, also among those that agree, differ by more than chance."
                }
            }
        }
    }
}

/// How many cells of each experiment are reached.
fn how_it_went(total: &Tally, all: &[Compared<'_>]) -> Markup {
    html! {
        @if total.total() > 0 {
            table .tallies {
                thead { tr { th scope="col" { "Experiment" } th scope="col" { "Section" } th scope="col" colspan="2" { "Printed numbers" } } }
                tbody { @for compared in all { (tally_of(compared)) } }
            }
            p .rule {
                @for (verdict, _) in total.counts() { (meaning(verdict)) " " }
                a href="#method" { "The rule in full" }
            }
            p .rule { (FITTED) " What a fifth more or less of each turns: " code { "docs/leverage.md" } "." }
        }
    }
}

/// What a verdict says, in short.
fn meaning(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Agrees => "Agree: our mean is within one printed standard deviation of the printed mean.",
        Verdict::Lower => "Lower: an error of the learner, smaller than printed by more.",
        Verdict::Higher => "Higher: an error of the learner, larger than printed by more.",
        Verdict::Differs => {
            "Differ: a number on which the learner has no influence (discard rate, alignment error, naive baseline), off by more."
        }
    }
}

fn tally_of(compared: &Compared<'_>) -> Markup {
    let experiment = compared.experiment;
    let tally = Tally::of([(compared.experiment, compared.result)]);
    html! {
        @if tally.total() > 0 {
            tr {
                th scope="row" {
                    a href={ "#" (experiment.id) } { (experiment.title) }
                    @if experiment.another_reading_of.is_some() { " (a second reading of the paper's text, not in the total)" }
                }
                td { (experiment.section) }
                td { (bar(&tally)) }
                td { (words(&tally)) }
            }
        }
    }
}

/// What stands behind the measures.
const NAMES: &str = "nUPE and nCPE: squared error of the learnt policy π, free and under the demonstrations' constraints (Nπ), over its variance; \
                     nMSE: the same of the potential φ. Rule (9): how the paper integrates φ along a movement.";

/// The cells that are higher than printed or otherwise off, each with what is known of it.
fn not_reached(all: &[Compared<'_>]) -> Markup {
    let (others, first): (Vec<_>, Vec<_>) =
        all.iter().partition(|compared| compared.experiment.another_reading_of.is_some());
    html! {
        (missed("Numbers that are higher or differ", &first))
        (missed("The same in the literal reading of Table 1, which is not counted above", &others))
        p .rule { (NAMES) }
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
