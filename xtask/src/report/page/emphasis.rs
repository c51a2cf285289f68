//! Sentences in which `**words**` are emphasised and others stand as code between backticks.

use maud::{Markup, html};

/// A sentence as HTML.
pub(super) fn emphasised(text: &str) -> Markup {
    html! {
        @for (i, part) in text.split("**").enumerate() {
            @if i % 2 == 1 { strong { (coded(part)) } } @else { (coded(part)) }
        }
    }
}

fn coded(text: &str) -> Markup {
    html! {
        @for (i, part) in text.split('`').enumerate() {
            @if i % 2 == 1 { code { (part) } } @else { (part) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_become_elements_and_the_rest_is_escaped() {
        let shown = emphasised("a < b **agrees** as `x & y` says").into_string();
        assert_eq!(shown, "a &lt; b <strong>agrees</strong> as <code>x &amp; y</code> says");
    }
}
