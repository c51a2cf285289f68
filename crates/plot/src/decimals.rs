//! Shorter numbers in drawings: rounding errors beyond the fourth decimal of a pixel are removed.

use std::fmt::Write as _;

/// Number of decimals that are kept.
const KEPT: usize = 4;

/// The drawing with rounded numbers in its attributes; text between elements does not change.
pub(crate) fn shortened(svg: &str) -> String {
    let mut short = String::with_capacity(svg.len());
    for part in svg.split_inclusive('>') {
        let (words, element) = part.split_at(part.find('<').unwrap_or(part.len()));
        short += words;
        shorten(element, &mut short);
    }
    short
}

/// Appends an element with its numbers rounded.
fn shorten(element: &str, short: &mut String) {
    let mut rest = element;
    while let Some(dot) = rest.find('.') {
        let after = &rest[dot + 1..];
        let decimals = after.bytes().take_while(u8::is_ascii_digit).count();
        let whole = rest[..dot].bytes().rev().take_while(u8::is_ascii_digit).count();
        let (before, number) = rest[..=dot + decimals].split_at(dot - whole);
        short.push_str(before);
        match number.parse::<f64>() {
            Ok(value) if decimals > KEPT && !after[decimals..].starts_with('e') => {
                let text = format!("{value:.KEPT$}");
                let _ = write!(short, "{}", text.trim_end_matches('0').trim_end_matches('.'));
            }
            _ => short.push_str(number),
        }
        rest = &rest[dot + 1 + decimals..];
    }
    short.push_str(rest);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn attributes_are_rounded_and_words_are_not() {
        let svg = "<path d=\"M-109.99000000000001 -.123456e2L3.25,0.00001\" id=\"v1.2\"/><text x=\"7\">0.0000125 and 1.</text>";
        let short = "<path d=\"M-109.99 -.123456e2L3.25,0\" id=\"v1.2\"/><text x=\"7\">0.0000125 and 1.</text>";
        assert_eq!(shortened(svg), short);
    }
}
