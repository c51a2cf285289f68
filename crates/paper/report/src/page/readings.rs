//! The readings of each kind of movement, if the run measured them.

use maud::{Markup, html};

use super::table::sideways;
use crate::compared::Compared;
use crate::learners::{READ_AS, confusion};

/// The experiment that measures the readings.
const EXPERIMENT: &str = "readings";

/// A table of the kinds of movements, with the number of data sets per reading.
pub(super) fn counts(compared: &Compared<'_>) -> Markup {
    html! {
        @if compared.experiment.id == EXPERIMENT {
            (sideways("How movements are read", &html! { table .counted {
                thead { tr { @for (at, name) in READ_AS.iter().enumerate() { th scope="col" .number[at > 0] { (name) } } } }
                tbody {
                    @for row in confusion(compared.result) {
                        tr {
                            th scope="row" { (row[0]) }
                            @for count in &row[1..] { td .number { (count) } }
                        }
                    }
                }
            } }))
        }
    }
}
