//! Reservations about an experiment and explanations of single cells that stand out, folded under its table.

use experiments::verdict::Verdict;
use maud::{Markup, html};
use page::emphasised;

use super::Contents;
use crate::compared::{Compared, Line};

/// The folded reservations and explanations; empty without any, or if the run was too small to judge.
pub(super) fn folded(compared: &Compared<'_>, contents: &Contents<'_>) -> Markup {
    let full = !contents.sources.results.quick && !compared.is_glimpse();
    let cells = if full { compared.standing_out() } else { vec![] };
    let said = if full { compared.experiment.reservations } else { &[] };
    html! {
        @if !cells.is_empty() || !said.is_empty() {
            details .reservations {
                summary { (title(cells.len())) }
                @if !said.is_empty() { ul .points { @for said in said { li { (emphasised(&sentence(said))) } } } }
                @if !cells.is_empty() {
                    p .minor { "Numbers quoted here are of the full run of seed 1." }
                    (reasons(&cells))
                }
            }
        }
    }
}

fn title(standing_out: usize) -> String {
    match standing_out {
        0 => "Reservations".to_owned(),
        1 => "Reservations, and a number further off than two standard errors or its band".to_owned(),
        count => format!("Reservations, and {count} numbers further off than two standard errors or their band"),
    }
}

/// Cells that stand out, with their explanations. Neighbouring cells with the same explanation share one entry.
fn reasons(cells: &[(Line<'_>, &str)]) -> Markup {
    html! {
        dl .reasons {
            @for alike in cells.chunk_by(|(_, a), (_, b)| a == b) {
                div .{ "is-" (worst(alike)) } {
                    @for (line, _) in alike { dt { code { (line.row.id) } " " (line.measure.label()) } }
                    dd { (emphasised(&sentence(alike[0].1))) }
                }
            }
        }
    }
}

/// The word of the worst verdict among the cells.
fn worst(cells: &[(Line<'_>, &str)]) -> &'static str {
    cells.iter().filter_map(|(line, _)| line.cell.verdict).max().map_or("", Verdict::word)
}

/// Capitalises the first letter.
fn sentence(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests {
    use experiments::measure::Measure::{
        self, AlignmentNmse, BeyondLimits, NaiveAll, Nupe, PolicyAlign, PotentialNmse,
    };
    use experiments::registry;
    use experiments::results::{Cell, Results};

    use super::sentence;

    const RECORDS: [&str; 2] = [
        include_str!("../../../../../docs/records/seed-1/results.json"),
        include_str!("../../../../../docs/records/seed-2/results.json"),
    ];

    #[test]
    fn a_sentence_begins_with_a_capital() {
        assert_eq!(["as in", "Über", ""].map(sentence), ["As in", "Über", ""]);
    }

    /// The records confirm the reservations that contain no number, or a number in words.
    #[test]
    fn reservations_match_the_records() {
        let said: Vec<&str> =
            registry().unwrap().iter().flat_map(|experiment| experiment.reservations).copied().collect();
        assert_eq!(said.len(), 4, "each has its lines below");
        for records in RECORDS {
            let results = Results::read("results.json", records).unwrap();
            let cell = |experiment: &str, row: &str, measure: Measure| -> &Cell {
                let rows = &results.experiment(experiment).unwrap().rows;
                &rows.iter().find(|other| other.id == row).unwrap().measures[&measure]
            };
            let table1 = |row: &str, measure| cell("table1", row, measure);
            let rows = registry().unwrap().into_iter().find(|experiment| experiment.id == "table1").unwrap().paper;
            let apart = rows.keys().map(|row| {
                let ratio = table1(row, AlignmentNmse).mean / table1(row, PotentialNmse).mean;
                ratio.max(1.0 / ratio)
            });
            assert_eq!(apart.fold(1.0, f64::max).round(), 2.0);
            let rise = |size: &str| {
                let [narrow, medium] =
                    ["narrow", "medium"].map(|width| table1(&format!("sinusoidal-{size}-{width}"), Nupe));
                (medium.mean > narrow.mean, medium.paper.unwrap().mean > narrow.paper.unwrap().mean)
            };
            assert_eq!([rise("40x40"), rise("100x100")], [(true, true), (false, false)]);
            let potential = cell("table2", "alignment", PotentialNmse);
            assert!(potential.mean > 4.0 * potential.paper.unwrap().mean);
            // As in the paper, the naive learner errs less under the training constraint, and nowhere else.
            for (row, less) in [("training", true), ("unseen_barrier", false), ("unconstrained", false)] {
                let [ours, naive] = [PolicyAlign, NaiveAll].map(|measure| cell("table2", row, measure));
                assert_eq!(naive.mean < ours.mean, less, "{row}");
                assert_eq!(naive.paper.unwrap().mean < ours.paper.unwrap().mean, less, "{row}");
            }
            let beyond = cell("asimo22", "policy_align", BeyondLimits).mean;
            assert!((75.0..85.0).contains(&beyond), "{beyond}");
            assert!(cell("asimo22", "body/naive", Nupe).mean < cell("asimo22", "policy_align", Nupe).mean);
        }
    }
}
