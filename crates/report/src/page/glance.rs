//! The opening: what was asked and how it went.

use experiments::measure::Measure;
use experiments::verdict::Verdict;
use experiments::{Experiment, settings};
use figures::ends_of_reaching;
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
                div {
                    p .lead {
                        "Demonstrations are made under unknown, changing constraints, which hide the policy. Howard, Klanke, Gienger, Goerick and Vijayakumar showed how to recover it ("
                        cite { "Behaviour Generation in Humanoids by Learning Potential-based Policies from Constrained Motion" }
                        "). policy-align repeats their experiments; this page holds its results against the paper's numbers."
                    }
                    (in_short(contents, all))
                }
                @if let Some((figure, svg)) = overview { (super::card(figure, svg, "")) }
                (total(&tally))
            }
            (how_it_went(&tally, all))
            @if tally.total() > 0 { (fitted()) }
            @if all.iter().any(Compared::is_glimpse) {
                p .notice { "With fewer than " (FEW) " data sets a row single numbers mean little." }
            } @else { (not_reached(all)) (pictures::otherwise(contents)) }
            (facts(contents, all))
        }
        (view::way(contents.sources))
    }
}

/// Table 2's row without any constraint, which says most shortly what the method is for.
const UNCONSTRAINED: &str = "unconstrained";

/// The method's claim and what became of it, where that was run.
fn in_short(contents: &Contents<'_>, all: &[Compared<'_>]) -> Markup {
    let table2 = all.iter().find(|compared| compared.experiment.id == view::EXPERIMENT);
    let row = table2.and_then(|table2| Some((table2, table2.rows().find(|row| row.id == UNCONSTRAINED)?)));
    let error = |of: Measure| {
        let (table2, row) = row?;
        let cell = table2.lines_of(row).find(|line| line.measure == of)?.cell;
        Some((cell.mean, format!("{:.2} (printed {:.2})", cell.mean, cell.paper?.mean)))
    };
    html! {
        @if let (Some((direct, naive)), Some((aligned, policy_align))) = (error(Measure::NaiveAll), error(Measure::PolicyAlign)) {
            p .lead {
                b { @if aligned < WORKS * direct { "In short: the policy is recovered where it was shown." } @else { "In short:" } }
                " With nothing in the robot’s way, the naive learner errs by " (naive) ", PolicyAlign, the paper’s method, by " (policy_align)
                ", as shares of the policy’s variance at the demonstrated states (Table 2)."
                @if let Some(ends) = ends_of_reaching(contents.sources) {
                    " Where movements end is another matter: PolicyAlign’s hands end " (centimetres(ends.policy_align))
                    " from where they should take the ball, the naive learner’s " (centimetres(ends.naive)) " (Figure 8)."
                }
            }
        }
    }
}

/// Metres, for people.
fn centimetres(metres: f64) -> String {
    format!("{:.0}\u{a0}cm", 100.0 * metres)
}

/// Of the naive learner's error, what PolicyAlign's must stay below to be called a success.
const WORKS: f64 = 0.5;

/// What is not the paper's.
fn fitted() -> Markup {
    html! {
        h2 .small { "What was fitted" }
        ul .points {
            li {
                (settings().len()) " settings that the paper does not print were chosen so that its numbers come out: how often the toy’s constraint \
                 is drawn anew, where ball, wall and obstacle are, the 22 joints’ attractor, time steps, the regressions’ widths and passes; the \
                 regression of the 22 joints alone was chosen for the lower error. " code { "docs/leverage.md" } " lists all of them, and which verdicts \
                 change when one is a fifth larger or smaller."
            }
            li {
                "Table 2 depends on them most: gaps narrower than 0.17 m are widened, which decides which of its numbers agree; the obstacle that no \
                 demonstration shows also stops the expert in half of the movements; movements last 50 s, the printed ones 2 s."
            }
        }
    }
}

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
                     ones. The others differ by more than chance, also where they agree: settings that the paper does not print were fitted."
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
                thead { tr { th scope="col" { "Experiment" } th scope="col" { "Section" } th scope="col" .number { "Fitted" } th scope="col" colspan="2" { "Printed numbers" } } }
                tbody { @for compared in all { (tally_of(compared)) } }
            }
            p .rule {
                @for (verdict, _) in total.counts() { (meaning(verdict)) " " }
                a href="#method" { "The rule in full" }
            }
        }
    }
}

/// What a verdict says, in short.
fn meaning(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Agrees => "Agree: our mean is within one printed standard deviation of the printed mean.",
        Verdict::Lower => {
            "Lower: an error of the learner, smaller than printed by more. This need not be better: an easier set-up or a smoother regression does the same."
        }
        Verdict::Higher => "Higher: an error of the learner, larger than printed by more.",
        Verdict::Differs => {
            "Differ: a number on which PolicyAlign’s regression has no influence (discard rate, alignment error, naive baseline), off by more."
        }
    }
}

/// How many settings of an experiment are fitted.
fn fitted_of(experiment: &Experiment) -> usize {
    let id = experiment.another_reading_of.unwrap_or(experiment.id);
    settings().iter().filter(|setting| setting.experiment == id).count()
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
                td .number data-label="fitted settings" { (fitted_of(experiment)) }
                td { (bar(&tally)) }
                td { (words(&tally)) }
            }
        }
    }
}

/// The cells that are higher than printed or otherwise off, each with what is known of it.
fn not_reached(all: &[Compared<'_>]) -> Markup {
    let (others, first): (Vec<_>, Vec<_>) =
        all.iter().partition(|compared| compared.experiment.another_reading_of.is_some());
    html! {
        (missed("Numbers that are higher or differ", &first))
        (missed("The same in the literal reading of Table 1, which is not counted above", &others))
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
