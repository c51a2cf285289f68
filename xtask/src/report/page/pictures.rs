//! Figures whose picture differs from the paper's, for the opening. What stands beside them says it in full.

use maud::{Markup, html};

use super::{Contents, figure};

/// The figures that are drawn and differ, each with what differs. A quick run is too coarse to tell.
pub(super) fn otherwise(contents: &Contents<'_>) -> Markup {
    let differ = contents.figures.iter().filter_map(|(figure, _)| Some((figure, figure.differs?)));
    let differ: Vec<_> = differ.collect();
    html! {
        @if !contents.sources.results.quick && !differ.is_empty() {
            h2 .small { "Pictures that differ from the paper’s" }
            ul .differ {
                @for (figure, words) in differ {
                    li { a href={ "#figure-" (figure.id) } { (figure::name(figure)) } ": " (words) }
                }
            }
        }
    }
}
