//! What is fitted in an experiment, and how much hangs on it.

use std::collections::BTreeMap;

use experiments::leverage::{Leverage, Turned};
use experiments::{Experiment, Setting, settings};
use maud::{Markup, html};

use super::table::sideways;
use crate::compared::Compared;

/// So many cells are named one by one.
const FEW: usize = 2;

/// Its settings, in order. Another reading of a table takes what the paper says as it stands, and the rest from the table.
pub(super) fn of(compared: &Compared<'_>) -> Vec<Setting> {
    let Experiment { id, another_reading_of: table, .. } = compared.experiment;
    let is_its = |setting: &Setting| match table {
        Some(table) => setting.experiment == *table && setting.is_unprinted(),
        None => setting.experiment == *id,
    };
    settings().into_iter().filter(is_its).collect()
}

/// A table of them; of another reading of a table none, as it stands there.
pub(super) fn table(compared: &Compared<'_>) -> Markup {
    let settings = of(compared);
    // Committed with the program, and tested.
    let leverage = Leverage::committed().ok();
    html! {
        @if !settings.is_empty() && compared.experiment.another_reading_of.is_none() {
            h3 { "What is fitted" }
            @if let Some(leverage) = &leverage {
                p .minor {
                    "Changed one at a time; verdicts that are then others than with the value used, on the same " (leverage.data_sets) " data sets of each \
                     row. (With so few a number on the edge may have another verdict than above.) All of them are named in " code { "docs/leverage.md" } "."
                }
            }
            (sideways(&format!("What is fitted: {}", compared.experiment.id), &html! {
                table .fitted {
                    thead {
                        tr {
                            th scope="col" { "Setting" }
                            th scope="col" { "The paper says" }
                            th scope="col" .number { "Used" }
                            th scope="col" { "A fifth smaller" }
                            th scope="col" { "A fifth larger" }
                        }
                    }
                    tbody {
                        @for setting in &settings {
                            tr {
                                th scope="row" { (setting.name) }
                                td { (setting.paper) }
                                td .number { (setting.shown()) }
                                @if let Some(changed) = leverage.as_ref().and_then(|leverage| leverage.of(setting)) {
                                    td { (in_short(&changed.smaller)) }
                                    td { (in_short(&changed.larger)) }
                                }
                            }
                        }
                    }
                }
            }))
        }
    }
}

/// Few cells by their names, many counted by what becomes of them.
fn in_short(turned: &[Turned]) -> String {
    let all: Vec<String> = if turned.len() <= FEW {
        turned.iter().map(Turned::named).collect()
    } else {
        let mut counts: BTreeMap<String, usize> = BTreeMap::new();
        for one in turned {
            *counts.entry(one.change()).or_default() += 1;
        }
        counts.iter().map(|(change, count)| format!("{count} × {change}")).collect()
    };
    if all.is_empty() { "none".to_owned() } else { all.join("; ") }
}

#[cfg(test)]
mod tests {
    use experiments::measure::Measure;
    use experiments::verdict::Verdict;

    use super::*;

    #[test]
    fn few_cells_are_named_and_many_counted() {
        let turned = |row: &str, is| Turned { row: row.to_owned(), measure: Measure::Nupe, was: Verdict::Agrees, is };
        assert_eq!(in_short(&[]), "none");
        assert_eq!(in_short(&[turned("narrow", Verdict::Lower)]), "narrow nUPE: agrees → lower");
        let three = [turned("a", Verdict::Lower), turned("b", Verdict::Higher), turned("c", Verdict::Lower)];
        assert_eq!(in_short(&three), "1 × agrees → higher; 2 × agrees → lower");
    }
}
