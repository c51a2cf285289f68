//! Colours and widths that many elements of a drawing share, written once.

use std::collections::HashMap;
use std::fmt::Write as _;

/// Attributes that a style sheet may hold as they stand.
const STYLES: [&str; 6] = ["fill", "stroke", "stroke-width", "opacity", "fill-opacity", "stroke-opacity"];

/// From so many elements with the same style on, a class is shorter.
const WORTH: usize = 8;

/// The drawing with a class for every style that recurs, and a style sheet at its beginning. It looks the same.
pub(crate) fn with_shared_styles(svg: &str) -> String {
    let mut count: HashMap<String, usize> = HashMap::new();
    for (_, element) in elements(svg) {
        if let Some((_, style)) = without_style(element) {
            *count.entry(style).or_default() += 1;
        }
    }
    count.retain(|_, count| *count >= WORTH);
    let mut classes: HashMap<String, usize> = HashMap::new();
    let (mut drawing, mut sheet, mut root_ends) = (String::with_capacity(svg.len()), String::new(), 0);
    for (words, element) in elements(svg) {
        drawing.push_str(words);
        match without_style(element).filter(|(_, style)| count.contains_key(style)) {
            Some((plain, style)) => {
                let next = classes.len();
                let class = *classes.entry(style).or_insert_with_key(|style| {
                    let _ = write!(sheet, ".s{next}{{{style}}}");
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
    if !sheet.is_empty() {
        drawing.insert_str(root_ends, &format!("<style>{sheet}</style>"));
    }
    drawing
}

/// Every tag, after the words before it.
fn elements(svg: &str) -> impl Iterator<Item = (&str, &str)> {
    svg.split_inclusive('>').map(|part| part.split_at(part.find('<').unwrap_or(part.len())))
}

/// A tag without what a style sheet may say, and that; nothing for a tag that has a style or a class of its own, or
/// nothing to say.
fn without_style(tag: &str) -> Option<(String, String)> {
    let (mut plain, mut style) = (String::new(), String::new());
    let mut pieces = tag.split('"');
    while let Some(before) = pieces.next() {
        let Some(value) = pieces.next() else {
            plain.push_str(before);
            break;
        };
        let (rest, name) = before.strip_suffix('=')?.rsplit_once(' ')?;
        match name {
            "class" | "style" => return None,
            name if STYLES.contains(&name) => {
                plain.push_str(rest);
                let _ = write!(style, "{name}:{value};");
            }
            _ => {
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
    fn what_recurs_is_said_once_and_the_rest_stays() {
        let dots = "<circle cx=\"8\" r=\"2\" fill=\"#0072b2\" stroke=\"none\" />".repeat(9);
        let rest = "<text fill=\"red\" x=\"1\">a > b</text><g class=\"k\" fill=\"#0072b2\" stroke=\"none\"></g>";
        let svg = format!("<svg width=\"9\">{dots}{rest}</svg>");
        let shared = with_shared_styles(&svg);
        assert!(shared.starts_with("<svg width=\"9\"><style>.s0{fill:#0072b2;stroke:none;}</style>"), "{shared}");
        assert!(
            shared.contains("<circle class=\"s0\" cx=\"8\" r=\"2\" />") && shared.ends_with(&format!("{rest}</svg>"))
        );
        assert!(shared.len() < svg.len());
    }

    #[test]
    fn what_is_rare_or_no_drawing_is_left_alone() {
        for text in ["", "words", "<svg><path d=\"M0 0\" fill=\"red\"/></svg>", "<svg a='b' fill=\"x\"", "<!-- \" -->"]
        {
            assert_eq!(with_shared_styles(text), text);
        }
    }
}
