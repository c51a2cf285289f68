//! How the results were measured, and how to repeat the measurement.

use maud::html;
use page::{Part, emphasised};

use super::Contents;
use super::facts::facts;
use crate::compared::Compared;
use crate::legend::RULE;

/// The last part of the page.
pub(super) fn part(contents: &Contents<'_>, all: &[Compared<'_>]) -> Part {
    let results = &contents.sources.results;
    let title = "How it was measured".to_owned();
    let body = html! {
        h2 { (title) }
        (facts(contents, all))
        p { (emphasised(RULE)) }
        h3 { "Run it yourself" }
        pre tabindex="0" { code {
            (results.run.command) "    # these numbers; on one machine, to the last bit\n"
            "cargo xtask reproduce --list      # experiments and rows, for --only\n"
            "cargo xtask report                # this page from a finished run"
        } }
        p .versions {
            "policy-align " (results.run.version)
            @if let Some(revision) = &results.run.revision { ", commit " code { (revision) } }
            ", results.json of form " (results.schema) ", seed " (results.seed) "."
        }
    };
    Part { id: "method".to_owned(), title, body }
}
