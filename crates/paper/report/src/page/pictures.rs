//! List of the figures that differ from the paper's. The text beside each figure gives the details.

use figures::undrawn;
use maud::{Markup, html};
use page::emphasised;

use super::Contents;

/// The figures of this run that differ, each with the difference. Empty for a quick run, which is too coarse to tell.
pub(super) fn otherwise(contents: &Contents<'_>) -> Markup {
    let undrawn = undrawn(contents.sources);
    let drawn = contents.figures.iter().map(|(figure, _)| (figure, true));
    let all = drawn.chain(undrawn.iter().map(|figure| (figure, false)));
    let differ: Vec<_> = all.filter_map(|(figure, drawn)| Some((figure, drawn, figure.differs?))).collect();
    html! {
        @if !contents.sources.results.quick && !differ.is_empty() {
            h2 .small { "Pictures that differ from the paper’s" }
            ul .differ {
                @for (figure, drawn, words) in differ {
                    @let name = page::name(figure.title);
                    li {
                        @if drawn { a href={ "#figure-" (figure.id) } { (name) } } @else { (name) }
                        ": " (emphasised(words))
                    }
                }
            }
        }
    }
}
