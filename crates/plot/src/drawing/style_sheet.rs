//! A style sheet for the colours and widths of a drawing. Styles that many elements share are written once, and colours
//! that change in dark mode are next to their counterparts.

use std::collections::HashMap;
use std::fmt::Write as _;

use crate::drawing::theme::{INK, dark, hex};

/// Attributes that can move to a style sheet unchanged.
const STYLES: [&str; 6] = ["fill", "stroke", "stroke-width", "opacity", "fill-opacity", "stroke-opacity"];

/// Number of elements with the same style from which a class is shorter.
const WORTH: usize = 8;

/// Class of pictures behind lines and words: light, so that black is legible on them.
pub(crate) const BACKDROP: &str = "class=\"backdrop\"";

/// Opacity of these in dark mode, where lines and words are light.
const DIMMED: f64 = 0.5;

/// The drawing with a class for every style that recurs or changes in dark mode, and a style sheet at its beginning. In
/// light mode and in print it looks the same. A viewer that does not support dark mode draws it as in light mode.
pub(crate) fn with_style_sheet(svg: &str) -> String {
    let mut count: HashMap<Style, usize> = HashMap::new();
    for (_, element) in elements(svg) {
        if let Some((_, style)) = without_style(element) {
            *count.entry(style).or_default() += 1;
        }
    }
    count.retain(|style, count| *count >= WORTH || in_the_dark(style).is_some());
    let mut classes: HashMap<Style, usize> = HashMap::new();
    let (mut light, mut in_dark) = (String::new(), format!("svg{{fill:{}}}", hex(INK)));
    let (mut drawing, mut root_ends) = (String::with_capacity(svg.len()), 0);
    for (words, element) in elements(svg) {
        drawing.push_str(words);
        match without_style(element).filter(|(_, style)| count.contains_key(style)) {
            Some((plain, style)) => {
                let next = classes.len();
                let class = *classes.entry(style).or_insert_with_key(|style| {
                    let _ = write!(light, ".s{next}{{{}}}", rules(style));
                    if let Some(other) = in_the_dark(style) {
                        let _ = write!(in_dark, ".s{next}{{{}}}", rules(&other));
                    }
                    next
                });
                let name_ends = plain.find([' ', '/', '>']).unwrap_or(plain.len());
                let _ = write!(drawing, "{} class=\"s{class}\"{}", &plain[..name_ends], &plain[name_ends..]);
            }
            None => drawing.push_str(element),
        }
        if element.starts_with("<svg") && root_ends == 0 {
            root_ends = drawing.len();
        }
    }
    if svg.contains(BACKDROP) {
        let _ = write!(in_dark, ".backdrop{{filter:brightness({DIMMED})}}");
    }
    if !light.is_empty() {
        let sheet = format!("<style>{light}@media screen and (prefers-color-scheme:dark){{{in_dark}}}</style>");
        drawing.insert_str(root_ends, &sheet);
    }
    drawing
}

/// Attribute names and values.
type Style = Vec<(&'static str, String)>;

fn rules(style: &Style) -> String {
    let rule = |(name, value): &(&str, String)| [name, ":", value, ";"].concat();
    style.iter().map(rule).collect()
}

/// The part of a style that changes in dark mode, if any.
fn in_the_dark(style: &Style) -> Option<Style> {
    let changed: Style = style.iter().filter_map(|(name, value)| Some((*name, dark(value)?))).collect();
    (!changed.is_empty()).then_some(changed)
}

/// All tags, each with the text before it.
fn elements(svg: &str) -> impl Iterator<Item = (&str, &str)> {
    svg.split_inclusive('>').map(|part| part.split_at(part.find('<').unwrap_or(part.len())))
}

/// Splits a tag into the attributes that cannot move to a style sheet, and those that can. `None` for a tag with a style
/// or class attribute, or without movable attributes.
fn without_style(tag: &str) -> Option<(String, Style)> {
    let (mut plain, mut style) = (String::new(), Style::new());
    let mut pieces = tag.split('"');
    while let Some(before) = pieces.next() {
        let Some(value) = pieces.next() else {
            plain.push_str(before);
            break;
        };
        let (rest, name) = before.strip_suffix('=')?.rsplit_once(' ')?;
        if ["class", "style"].contains(&name) {
            return None;
        }
        match STYLES.into_iter().find(|style| *style == name) {
            Some(name) => {
                plain.push_str(rest);
                style.push((name, value.to_owned()));
            }
            None => {
                let _ = write!(plain, "{before}\"{value}\"");
            }
        }
    }
    (!style.is_empty()).then_some((plain, style))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn repeated_styles_are_written_once() {
        let dots = "<circle cx=\"8\" r=\"2\" fill=\"#0072b2\" stroke=\"none\" />".repeat(9);
        let rest = "<text fill=\"red\" x=\"1\">a > b</text><g class=\"k\" fill=\"#0072b2\" stroke=\"none\"></g>";
        let svg = format!("<svg width=\"9\">{dots}{rest}</svg>");
        let shared = with_style_sheet(&svg);
        assert!(shared.starts_with("<svg width=\"9\"><style>.s0{fill:#0072b2;stroke:none;}@media"), "{shared}");
        assert!(
            shared.contains("<circle class=\"s0\" cx=\"8\" r=\"2\" />") && shared.ends_with(&format!("{rest}</svg>"))
        );
        assert!(shared.len() < svg.len());
    }

    #[test]
    fn rare_styles_and_other_texts_are_unchanged() {
        for text in ["", "words", "<svg><path d=\"M0 0\" fill=\"red\"/></svg>", "<svg a='b' fill=\"x\"", "<!-- \" -->"]
        {
            assert_eq!(with_style_sheet(text), text);
        }
    }

    #[test]
    fn paper_and_ink_have_colours_of_the_dark() {
        let svg = "<svg><rect fill=\"white\"/><path fill=\"none\" stroke=\"#000000\"/><path stroke=\"#009e73\"/></svg>";
        let sheet = "<style>.s0{fill:white;}.s1{fill:none;stroke:#000000;}@media screen and (prefers-color-scheme:dark){\
                     svg{fill:#e4e7ea}.s0{fill:#1b1f23;}.s1{stroke:#e4e7ea;}}</style>";
        let drawn = "<rect class=\"s0\"/><path class=\"s1\"/><path stroke=\"#009e73\"/></svg>";
        assert_eq!(with_style_sheet(svg), format!("<svg>{sheet}{drawn}"));
    }
}
