//! The number of cells per verdict, as a bar and in words.

use maud::{Markup, html};

use crate::tally::{Tally, after};

/// The bar alone; the words beside it give the same numbers.
pub(super) fn bar(tally: &Tally) -> Markup {
    html! {
        div .bar aria-hidden="true" {
            @for (verdict, count) in tally.counts() {
                span .{ "is-" (verdict.word()) } style={ "flex-grow:" (count) } {}
            }
        }
    }
}

/// The numbers, each with its colour and verdict.
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
