//! Sentences with emphasis (`**words**`), code (between backticks) and powers (after `^`). Terms are not broken across
//! lines.

use maud::{Markup, html};

/// Largest number of letters of a term in brackets.
const LONGEST: usize = 24;

/// A sentence as HTML: text between `**` and `**` is emphasised, between backticks it is code, after `^` a power. Terms
/// such as `[-1, 1]^3` are not broken at the end of a line.
pub fn emphasised(text: &str) -> Markup {
    html! {
        @for (i, part) in text.split("**").enumerate() {
            @if i % 2 == 1 { strong { (coded(part)) } } @else { (coded(part)) }
        }
    }
}

fn coded(text: &str) -> Markup {
    html! {
        @for (i, part) in text.split('`').enumerate() {
            @if i % 2 == 1 { code { (part) } } @else { (termed(part)) }
        }
    }
}

/// Words with line breaks prevented within terms.
fn termed(text: &str) -> Markup {
    let text = text.replace(" = ", "\u{a0}=\u{a0}").replace(" %", "\u{a0}%").replace(" cm", "\u{a0}cm");
    html! {
        @for word in words(&text) {
            @if is_term(word) { span .term { (powers(word.trim_end())) } @if word.ends_with(' ') { " " } }
            @else { (powers(word)) }
        }
    }
}

/// Words with the space after them; text in square brackets is one word.
fn words(text: &str) -> Vec<&str> {
    let mut words = vec![];
    let mut rest = text;
    while !rest.is_empty() {
        let space = rest.find(' ');
        let closed = space.and_then(|space| {
            let open = rest[..space].rfind('[').filter(|&open| !rest[open..space].contains(']'))?;
            let close = open + rest[open..].find(']').filter(|&length| length < LONGEST)?;
            Some(rest[close..].find(' ').map(|after| close + after))
        });
        let end = closed.unwrap_or(space).map_or(rest.len(), |space| space + 1);
        words.push(&rest[..end]);
        rest = &rest[end..];
    }
    words
}

/// Whether a word is an interval, a power, or a name with a hyphen next to a single letter.
fn is_term(word: &str) -> bool {
    let name = word.trim_matches(|letter: char| !letter.is_alphanumeric());
    let mut parts = name.split('-');
    let single = name.contains('-') && parts.any(|part| part.chars().count() == 1);
    single || word.contains('^') || word.trim_end().contains(' ')
}

fn powers(word: &str) -> Markup {
    html! {
        @for (i, part) in word.split('^').enumerate() {
            @let end = part.find(|letter: char| !letter.is_alphanumeric()).unwrap_or(part.len());
            @if i > 0 { sup { (part[..end]) } (part[end..]) } @else { (part) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(text: &str) -> String {
        emphasised(text).into_string()
    }

    #[test]
    fn marks_become_elements_and_the_rest_is_escaped() {
        let expected = "a &lt; b <strong>agrees</strong> as <code>x &amp; y^2</code> says";
        assert_eq!(shown("a < b **agrees** as `x & y^2` says"), expected);
    }

    #[test]
    fn terms_stay_together() {
        assert_eq!(
            shown("uniform in [-1, 1]^3, plain"),
            "uniform in <span class=\"term\">[-1, 1]<sup>3</sup>,</span> plain"
        );
        assert_eq!(shown("line (rows r-c). The"), "line (rows <span class=\"term\">r-c).</span> The");
        assert_eq!(shown("well-known, δt = 0.5 s"), "well-known, δt\u{a0}=\u{a0}0.5 s");
        assert_eq!(shown("an open [ bracket in a line"), "an open [ bracket in a line");
    }
}
