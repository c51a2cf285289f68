//! A figure on a card.

use std::fmt::Write as _;

use maud::{Markup, html};

use crate::emphasised;

/// A picture with title and caption, under a heading that may repeat the title; the title is then visible only in the
/// enlarged figure. The picture is an image and not part of the page, so that its ids cannot clash. The caption
/// describes it, so it has no alternative text. It must adapt to the reader's light or dark mode by itself.
#[derive(Debug, Clone, Copy)]
pub struct Card<'a> {
    /// The card's address within the page is `figure-<id>`.
    pub id: &'a str,
    /// "Figure 8: …", or a title without a number.
    pub title: &'a str,
    /// The caption, in the format of [`emphasised`](crate::emphasised).
    pub caption: &'a str,
    /// A separate paragraph below the caption: its heading and its text.
    pub remark: Option<(&'a str, &'a str)>,
    /// The picture.
    pub svg: &'a str,
}

impl Card<'_> {
    /// The card, under this heading.
    pub fn under(&self, heading: &str) -> Markup {
        let (width, height) = size(self.svg);
        html! {
            figure id={ "figure-" (self.id) } aria-label=(name(self.title)) {
                button .enlarge type="button" aria-label={ "Enlarge " (name(self.title)) } {
                    img src=(data_uri(self.svg)) alt="" width=[width] height=[height];
                }
                figcaption {
                    p { strong hidden[self.title == heading] { (self.title) "." } " " (emphasised(self.caption)) }
                    @if let Some((heading, text)) = self.remark { p { strong { (heading) } " " (emphasised(text)) } }
                }
            }
        }
    }
}

/// A dialog that shows a figure as large as the window allows.
pub(crate) fn enlarged() -> Markup {
    html! {
        dialog #enlarged {
            form method="dialog" { button { "Close " kbd aria-hidden="true" { "Esc" } } }
            div .picture tabindex="0" role="group" aria-label="Picture" {}
            div .caption {}
        }
    }
}

/// The title of a figure up to the colon: "Figure 8". A figure without a number is called a picture.
pub fn name(title: &str) -> &str {
    title.split_once(':').map_or("picture", |(name, _)| name)
}

/// The picture as a data URI that is hardly longer than the picture. Browsers accept spaces in such an address, and
/// single quotes around attributes need no escaping.
fn data_uri(svg: &str) -> String {
    let mut uri = String::with_capacity(svg.len() * 5 / 4) + "data:image/svg+xml,";
    for part in svg.split_inclusive('>') {
        let (words, element) = part.split_at(part.find('<').unwrap_or(part.len()));
        add(words, &mut uri);
        let quotes = if element.contains('\'') { "\"" } else { "'" };
        add(&element.replace('"', quotes), &mut uri);
    }
    uri
}

/// Appends a piece of a picture to an address.
fn add(piece: &str, uri: &mut String) {
    for byte in piece.bytes() {
        match byte {
            // Bytes that end an address or an attribute, or are not allowed in one.
            b'"' | b'#' | b'%' | b'&' | b'<' | 0..b' ' | 127.. => {
                let _ = write!(uri, "%{byte:02X}");
            }
            _ => uri.push(char::from(byte)),
        }
    }
}

/// Width and height of the drawing, pixels; with them the page layout does not shift when it appears.
fn size(svg: &str) -> (Option<&str>, Option<&str>) {
    let root = svg.split_once("<svg").and_then(|(_, rest)| rest.split_once('>')).map_or("", |(root, _)| root);
    let attribute = |name: &str| {
        let (_, rest) = root.split_once(&format!(" {name}=\""))?;
        rest.split_once('"').map(|(value, _)| value)
    };
    (attribute("width"), attribute("height"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_is_one_address_with_its_size() {
        let svg = "<svg xmlns=\"x\" width=\"12\" height=\"7.5\"><path stroke=\"#000\" width=\"3\"/>\"é\" isn't 5%\n<g id=\"a'\"/></svg>";
        assert_eq!(size(svg), (Some("12"), Some("7.5")));
        let expected = "data:image/svg+xml,%3Csvg xmlns='x' width='12' height='7.5'>%3Cpath stroke='%23000' width='3'/>\
                        %22%C3%A9%22 isn't 5%25%0A%3Cg id=%22a'%22/>%3C/svg>";
        assert_eq!(data_uri(svg), expected);
    }
}
