//! What is fitted in an experiment, and how much hangs on it.

use std::collections::BTreeMap;

use experiments::leverage::{Leverage, Turned};
use experiments::{Experiment, Setting, settings};
use maud::{Markup, html};

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
    let settings = if compared.experiment.another_reading_of.is_none() { of(compared) } else { Vec::new() };
    // Committed with the program, and tested.
    let leverage = Leverage::committed().ok();
    let changed = |setting: &Setting| leverage.as_ref().and_then(|leverage| leverage.of(setting));
    html! {
        @if !settings.is_empty() {
            h3 { "What is fitted" }
            @if let Some(leverage) = &leverage {
                p .minor {
                    "Changed one at a time; verdicts that are then others than with the value used, on the same " (leverage.data_sets) " data sets of each \
                     row. (With so few a number on the edge may have another verdict than above.) All of them are named in " code { "docs/leverage.md" } "."
                }
            }
            div .sideways tabindex="0" role="region" aria-label={ "What is fitted: " (compared.experiment.id) } {
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
                                @for turned in changed(setting).map_or([None; 2], |changed| [Some(&changed.smaller), Some(&changed.larger)]) {
                                    td { (turned.map_or(String::new(), |turned| in_short(turned))) }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Few cells by their names, many counted by what becomes of them.
fn in_short(turned: &[Turned]) -> String {
    let change = |turned: &Turned| format!("{} → {}", turned.was.word(), turned.is.word());
    let all: Vec<String> = if turned.len() <= FEW {
        turned.iter().map(|one| format!("{} {}: {}", one.row, one.measure.label(), change(one))).collect()
    } else {
        let mut counts: BTreeMap<String, usize> = BTreeMap::new();
        for one in turned {
            *counts.entry(change(one)).or_default() += 1;
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
