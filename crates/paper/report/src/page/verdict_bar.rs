//! How many cells are reached, as a bar and in words.

use maud::{Markup, html};

use crate::tally::{Tally, after};

/// The bar alone; it says the same as the words beside it.
pub(super) fn bar(tally: &Tally) -> Markup {
    html! {
        div .bar aria-hidden="true" {
            @for (verdict, count) in tally.counts() {
                span .{ "is-" (verdict.word()) } style={ "flex-grow:" (count) } {}
            }
        }
    }
}

/// The numbers, each with its colour and words.
pub(super) fn words(tally: &Tally) -> Markup {
    html! {
        ul .counts {
            @for (verdict, count) in tally.counts() {
                li data-verdict=(verdict.word()) {
                    span .swatch .{ "is-" (verdict.word()) } aria-hidden="true" {}
                    b { (count) } " " (after(verdict, count))
                }
            }
        }
    }
}
