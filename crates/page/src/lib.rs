//! Presentation of a report: one self-contained HTML page, and tables in Markdown.
//!
//! - [`Document`]: the page, with contents, style and script. [`Part`]: a part with an address.
//! - [`Card`]: a figure that can be enlarged, given as SVG.
//! - [`Strip`] on a [`Scale`]: every value of a cell as a dot, so that outliers are visible. [`axis`], [`key`] explain them.
//! - [`emphasised`]: sentences with emphasis, code and powers.
//! - [`markdown_table`]: a table in Markdown.
//!
//! The caller provides the contents. Bodies are [`maud::Markup`], which escapes inserted text.
//!
//! ```
//! use maud::html;
//! use page::{Document, Part, Scale, Strip};
//!
//! let values = [Some(0.02), None, Some(0.03), Some(0.07)];
//! let show = |value: f64| format!("{value:.2}");
//! let strip = Strip { values: &values, mean: 0.04, median: 0.03, reference: None, show: &show };
//! let scale = Scale::around(values.into_iter().flatten(), []);
//! let opening = Part { id: "glance".to_owned(), title: "At a glance".to_owned(), body: html! { (strip.drawn(scale)) } };
//! let page = Document { title: "A run", name: "my robot", opening, parts: vec![], style: "" }.html();
//! assert!(page.contains("3 data sets between 0.02 and 0.07, median 0.03"));
//! ```

mod document;
mod emphasis;
mod figure;
mod markdown;
mod scale;
mod strip;

pub use document::{Document, Part};
pub use emphasis::emphasised;
pub use figure::{Card, name};
pub use markdown::markdown_table;
pub use scale::{Reference, Scale};
pub use strip::{Strip, axis, key};

/// Compiles the README's program.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
