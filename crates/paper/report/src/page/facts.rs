//! Facts about the run: seed, number of data sets, time.

use experiments::Setup;
use experiments::results::Results;
use figures::{Figure, Sources, drawn_in_part, undrawn};
use maud::{Markup, html};

use super::Contents;
use crate::compared::Compared;
use crate::tally::Tally;

/// Seconds from which a time is shown in minutes.
const MINUTES_FROM: f64 = 120.0;

/// Seconds from which a time is shown in hours.
const HOURS_FROM: f64 = 7200.0;

/// A list of facts.
pub(super) fn facts(contents: &Contents<'_>, all: &[Compared<'_>]) -> Markup {
    let results = &contents.sources.results;
    let run = &results.run;
    html! {
        dl .facts {
            div { dt { "Seed" } dd { (results.seed) } }
            div { dt { "Data sets" } dd { (all.iter().map(data_sets).sum::<usize>()) } }
            div {
                dt { "Time" }
                dd {
                    (time(run.cpu_seconds)) " of processor time, " (time(run.wall_seconds)) " elapsed, " (run.threads_in_words())
                    @if run.resumed > 0 { ", " (run.resumed) " data sets from earlier calls" }
                }
            }
            @if let Some(second) = contents.second {
                div { dt { "Another run" } dd { "seed " (second.seed) ": "  (beside(second, all)) } }
            }
        }
    }
}

/// Notices of figures, or parts of figures, whose data are missing.
pub(super) fn missing(contents: &Contents<'_>) -> Markup {
    let notice = |what: &str, find: fn(&Sources) -> Vec<Figure>| {
        let names: Vec<&str> = find(contents.sources).iter().map(|figure| page::name(figure.title)).collect();
        html! {
            @if !names.is_empty() {
                p .notice {
                    (what) ", as their figure data are missing: " (names.join("; ")) ". " code { (contents.sources.results.run.command) }
                    " computes them."
                }
            }
        }
    };
    html! { (notice("Not drawn", undrawn)) (notice("Drawn in part", drawn_in_part)) }
}

/// Results of the other run, restricted to the experiments of this run.
fn beside(second: &Results, all: &[Compared<'_>]) -> String {
    let here = |id: &str| {
        let mut first_readings = all.iter().filter(|compared| compared.experiment.another_reading_of.is_none());
        first_readings.find(|compared| compared.experiment.id == id).map(|compared| compared.experiment)
    };
    Tally::of(second.experiments.iter().filter_map(|result| Some((here(&result.id)?, result)))).sentence()
}

/// Number of data sets of an experiment; all rows of a setup share the same data sets.
fn data_sets(compared: &Compared<'_>) -> usize {
    let rows = &compared.result.rows;
    let of_setup = |setup: &Setup| {
        let row = rows.iter().find(|row| setup.rows.iter().any(|other| other.id == row.id));
        row.map_or(0, |row| row.data_sets)
    };
    compared.experiment.setups.iter().map(of_setup).sum()
}

/// A time in a readable unit: seconds, minutes or hours.
fn time(seconds: f64) -> String {
    if seconds < MINUTES_FROM {
        format!("{seconds:.0} s")
    } else if seconds < HOURS_FROM {
        format!("{:.0} min", seconds / 60.0)
    } else {
        format!("{:.1} h", seconds / 3600.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_shown_in_fitting_units() {
        let shown = [0.4, 98.9, 119.0, 120.0, 3599.0, 9000.0].map(time);
        assert_eq!(shown, ["0 s", "99 s", "119 s", "2 min", "60 min", "2.5 h"]);
    }
}
