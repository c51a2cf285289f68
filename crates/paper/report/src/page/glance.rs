//! The opening: the question and the results.

use std::collections::BTreeSet;

use experiments::measure::Measure;
use experiments::verdict::Verdict;
use experiments::{Experiment, Method, n_fitted};
use figures::ends_of_reaching;
use maud::{Markup, html};

use super::facts::missing;
use super::fitted;
use super::verdict_bar::{bar, words};
use super::{Contents, OVERVIEW, view};
use crate::compared::{Compared, FEW, Line};
use crate::comparisons::Comparisons;
use crate::tally::Tally;

pub(super) fn opening(contents: &Contents<'_>, all: &[Compared<'_>]) -> Markup {
    let tally = Tally::of_first_readings(all.iter().map(|compared| (compared.experiment, compared.result)));
    let literal = Tally::of_literal_readings(all.iter().map(|compared| (compared.experiment, compared.result)));
    let overview = contents.figures.iter().find(|(figure, _)| figure.id == OVERVIEW);
    html! {
        header #glance {
            h1 { "Learn the movement, not the constraint" }
            div .first {
                // On a phone in this order: the picture before the numbers.
                div {
                    p .lead {
                        "Demonstrations are made under unknown, changing constraints, which hide the policy. Howard, Klanke, Gienger, Goerick and Vijayakumar showed how to recover it ("
                        cite { "Behaviour Generation in Humanoids by Learning Potential-based Policies from Constrained Motion" }
                        "). policy-align repeats their experiments; this page compares its results with the paper’s numbers."
                    }
                    (in_short(contents, all))
                }
                @if let Some((figure, svg)) = overview { (super::card(figure, svg, "")) }
                (total(&tally, &literal))
            }
            (verdicts_by_experiment(&tally, all))
            @if all.iter().any(Compared::is_glimpse) {
                p .notice { "With fewer than " (FEW) " data sets a row single numbers mean little." }
            } @else { (not_reached(all)) }
            (missing(contents))
            (view::way(contents.sources))
        }
    }
}

/// Table 2's row without any constraint, which shows the purpose of the method most directly.
const UNCONSTRAINED: &str = "unconstrained";

/// The method's claim and its outcome, if the run includes Table 2.
fn in_short(contents: &Contents<'_>, all: &[Compared<'_>]) -> Markup {
    let table2 = all.iter().find(|compared| compared.experiment.id == view::EXPERIMENT);
    let row = table2.and_then(|table2| Some((table2, table2.rows().find(|row| row.id == UNCONSTRAINED)?)));
    let error = |of: Measure| {
        let (table2, row) = row?;
        let cell = table2.lines_of(row).find(|line| line.measure == of)?.cell;
        Some(format!("{:.2} (in the paper {:.2})", cell.mean, cell.paper?.mean))
    };
    html! {
        @if let (Some(naive), Some(policy_align)) = (error(Measure::NaiveAll), error(Measure::PolicyAlign)) {
            p .lead {
                b { "In short:" }
                " with nothing in the robot’s way (Table 2), PolicyAlign, the paper’s method, has an error of " (policy_align)
                ", the naive learner, which takes movements as they were seen, one of " (naive) ", both as shares of the policy’s variance at the demonstrated states."
                @for experiment in naive_ahead(all) {
                    " The naive learner errs less than PolicyAlign throughout in “" a href={ "#" (experiment.id) } { (experiment.title) } "”."
                }
                @if let Some(ends) = ends_of_reaching(contents.sources) {
                    " And PolicyAlign’s movements do not end well: its hands end " (centimetres(ends.policy_align))
                    " from where they should take the ball, the naive learner’s " (centimetres(ends.naive)) " (Figure 8)."
                }
            }
        }
    }
}

/// A length in metres, shown in centimetres.
fn centimetres(metres: f64) -> String {
    format!("{:.0}\u{a0}cm", 100.0 * metres)
}

/// The experiments with printed numbers in which the naive learner errs less than PolicyAlign for every policy.
fn naive_ahead<'a>(all: &[Compared<'a>]) -> impl Iterator<Item = &'a Experiment> {
    let is_ahead = |compared: &&Compared<'_>| {
        let comparisons = Comparisons::of(compared.experiment, compared.result);
        let of_policies = comparisons
            .iter()
            .flat_map(|comparisons| &comparisons.lines)
            .filter(|line| line.comparison.measure == Measure::Nupe);
        let ahead: Vec<bool> = of_policies.map(|line| line.is_ahead_of_policy_align(Method::Naive)).collect();
        !ahead.is_empty() && ahead.into_iter().all(|ahead| ahead)
    };
    all.iter().filter(|compared| compared.is_printed()).filter(is_ahead).map(|compared| compared.experiment)
}

/// How close all numbers are to the printed ones, for both readings of Table 1, with the statistical significance.
fn total(total: &Tally, literal: &Tally) -> Markup {
    html! {
        @if let Some(median) = total.median_factor() {
            div .total {
                p .factor { "The median factor between our numbers and the printed ones is " b { (format!("{median:.2}")) } "; " (close(total)) "." }
                p .asked { "Of " b { (total.total()) } " numbers that the paper prints" }
                (words(total))
                (bar(total))
                @if literal.sentence() != total.sentence() {
                    p {
                        "With Table 1 as the paper says it (“re-sampled twice”: three segments a movement) instead of as it fits best: " (literal.verdicts())
                        "; median factor " (format!("{:.2}", literal.median_factor().unwrap_or(1.0))) ", " (close(literal)) "."
                    }
                }
                p {
                    "Statistically: of the " (total.varying()) " means that vary from data set to data set, " b { (total.alike()) } " are within two standard errors \
                     of the printed ones. The other " (total.varying() - total.alike()) "
                     can be told apart from them, though many count as agreeing, and " (n_fitted()) " numbers were fitted."
                }
            }
        }
    }
}

/// "48 of 52 are within 1.5".
fn close(tally: &Tally) -> String {
    let (close, all) = tally.close();
    format!("{close} of {all} are within a factor of 1.5")
}

/// The number of cells per verdict, for each experiment.
fn verdicts_by_experiment(total: &Tally, all: &[Compared<'_>]) -> Markup {
    html! {
        @if total.total() > 0 {
            table .tallies {
                thead { tr { th scope="col" { "Experiment" } th scope="col" { "Section" } th scope="col" .number { "Fitted settings (some shared)" } th scope="col" colspan="2" { "Printed numbers" } } }
                tbody { @for compared in all { (tally_of(compared)) } }
            }
            p .rule {
                @for (verdict, _) in total.counts() { (meaning(verdict)) " " }
                a href="#method" { "The rule in full" }
            }
        }
    }
}

/// A short explanation of a verdict.
fn meaning(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Agrees => "Agree: our mean is within one printed standard deviation of the printed mean.",
        Verdict::Lower => {
            "Lower: an error of PolicyAlign, more than that below the printed one. This need not be better: an easier set-up or a smoother regression does the same."
        }
        Verdict::Higher => "Higher: an error of PolicyAlign, more than that above the printed one.",
        Verdict::Differs => {
            "Differ: a number on which PolicyAlign’s regression has no influence (discard rate, alignment error, naive learner) and that is more than that above or below the printed one."
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
                    @if experiment.another_reading_of.is_some() { " (as the paper says it; not counted)" }
                }
                td { (experiment.section) }
                td .number data-label="fitted settings" { (fitted::count(compared)) }
                td { (bar(&tally)) }
                td { (words(&tally)) }
            }
        }
    }
}

/// The cells that are higher than printed or differ otherwise. Explanations are under their tables.
fn not_reached(all: &[Compared<'_>]) -> Markup {
    let (others, first): (Vec<_>, Vec<_>) =
        all.iter().partition(|compared| compared.experiment.another_reading_of.is_some());
    html! {
        (missed("", &first))
        (missed(" in Table 1, taken literally, not counted above", &others))
    }
}

fn missed(of: &str, among: &[&Compared<'_>]) -> Markup {
    let missed = |line: &Line<'_>| line.cell.verdict.is_some_and(|verdict| !verdict.reached());
    let mut cells = vec![];
    for compared in among {
        cells.extend(compared.lines().filter(missed).map(|line| (compared.experiment, line)));
    }
    let verdicts: BTreeSet<Verdict> = cells.iter().filter_map(|(_, line)| line.cell.verdict).collect();
    let which: Vec<&str> = verdicts.into_iter().map(Verdict::plural).collect();
    html! {
        @if !cells.is_empty() {
            p .missed { b { "Numbers that " (which.join(" or ")) (of) ":" } }
            ul .missed {
                @for (experiment, line) in cells {
                    li data-verdict=(line.verdict()) {
                        a href={ "#" (experiment.id) } { (experiment.title) } ", " code { (line.row.id) } " " (line.measure.label()) ": "
                        (line.ours()) ", printed " (line.paper())
                    }
                }
            }
        }
    }
}
