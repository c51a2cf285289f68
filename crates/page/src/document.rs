use maud::{DOCTYPE, Markup, PreEscaped, html};

use crate::figure::enlarged;

const STYLE: &str = include_str!("report.css");
const SCRIPT: &str = include_str!("report.js");

/// The page may show only embedded contents; it fetches nothing.
const POLICY: &str = "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'";

/// A page with embedded style, script and pictures.
#[derive(Debug)]
pub struct Document<'a> {
    /// Title of the window.
    pub title: &'a str,
    /// Name above the contents.
    pub name: &'a str,
    /// The first part.
    pub opening: Part,
    /// The following parts, as sections.
    pub parts: Vec<Part>,
    /// An additional style sheet, after that of the page.
    pub style: &'a str,
}

/// A part of the page with an address.
#[derive(Debug)]
pub struct Part {
    /// Its address within the page. That of the opening belongs to the heading in its body.
    pub id: String,
    /// Its title in the contents.
    pub title: String,
    /// Its HTML.
    pub body: Markup,
}

impl Document<'_> {
    /// The page as HTML.
    pub fn html(&self) -> String {
        let document = html! {
            (DOCTYPE)
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta name="viewport" content="width=device-width, initial-scale=1";
                    meta name="color-scheme" content="light dark";
                    meta http-equiv="Content-Security-Policy" content=(POLICY);
                    title { (self.title) }
                    link rel="icon" href="data:,";
                    style { (PreEscaped(STYLE)) (PreEscaped(self.style)) }
                }
                body {
                    a .skip href="#main" { "Skip to the results" }
                    (self.contents())
                    main #main tabindex="-1" {
                        (self.opening.body)
                        @for part in &self.parts { section id=(part.id) { (part.body) } }
                    }
                    (enlarged())
                    script type="module" { (PreEscaped(SCRIPT)) }
                }
            }
        };
        document.into_string()
    }

    fn contents(&self) -> Markup {
        html! {
            nav aria-label="Contents" {
                p .name { (self.name) }
                // The script folds the contents in a narrow window.
                details open {
                    summary { "Contents" }
                    ol {
                        @for part in std::iter::once(&self.opening).chain(&self.parts) {
                            li { a href={ "#" (part.id) } { (part.title) } }
                        }
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_in_the_contents_and_nothing_is_fetched() {
        let part = |id: &str| Part { id: id.to_owned(), title: format!("<{id}>"), body: html! { p { (id) } } };
        let page = Document { title: "t", name: "n", opening: part("a"), parts: vec![part("b")], style: "b { x: y }" };
        let page = page.html();
        for id in ["a", "b"] {
            assert!(page.contains(&format!("<a href=\"#{id}\">&lt;{id}&gt;</a>")), "{page}");
        }
        assert!(page.contains("<section id=\"b\"><p>b</p></section>") && page.contains("b { x: y }</style>"));
        assert!(page.contains("default-src 'none'") && !page.contains("http:") && !page.contains("https:"));
    }
}
