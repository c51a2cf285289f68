//! The fitted settings of an experiment, and how strongly the verdicts depend on them.

use std::collections::BTreeMap;

use experiments::leverage::{Leverage, Turned};
use experiments::{Class, Experiment, Setting, settings};
use maud::{Markup, html};

use super::table::sideways;
use crate::compared::Compared;

/// Up to this many cells are named individually.
const FEW: usize = 2;

/// Number of fitted settings of an experiment. A literal reading of a table takes one of them from the paper.
pub(super) fn count(compared: &Compared<'_>) -> usize {
    let Experiment { id, another_reading_of: table, .. } = compared.experiment;
    let fitted = of(table.unwrap_or(id)).iter().filter(|setting| setting.class == Class::Fitted).count();
    fitted - usize::from(table.is_some())
}

/// The settings of an experiment, in order.
fn of(id: &str) -> Vec<Setting> {
    settings().into_iter().filter(|setting| setting.experiment == id).collect()
}

/// A table of the settings; another reading of a table has no separate settings.
pub(super) fn table(compared: &Compared<'_>) -> Markup {
    let settings = of(compared.experiment.id);
    // The leverage file is committed with the program and covered by a test.
    let leverage = Leverage::committed().ok();
    html! {
        @if !settings.is_empty() {
            h3 { "Settings, and what was fitted" }
            @if let Some(leverage) = &leverage {
                p .minor {
                    "Each setting is of the paper, a default of the LWPR library, or fitted. Changed one at a time; verdicts that are then others than with the value used, on the same " (leverage.data_sets) " data sets of each \
                     row. (With so few a number on the edge may have another verdict than above.) All of them are named in " code { "docs/leverage.md" } "."
                }
            }
            (sideways(&format!("Settings: {}", compared.experiment.id), &html! {
                table .fitted {
                    thead {
                        tr {
                            th scope="col" { "Setting" }
                            th scope="col" { "Class" }
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
                                td { (setting.class.name()) }
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

/// Names a few cells individually; counts many cells by the change of their verdicts.
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
