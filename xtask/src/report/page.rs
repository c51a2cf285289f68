//! The report as one self-contained page.

use crate::experiments::Experiment;
use crate::figures::{Figure, Sources};
use crate::results::Results;

/// What the page shows.
#[allow(dead_code, reason = "the page is being built")]
pub(crate) struct Contents<'a> {
    pub(crate) experiments: &'a [Experiment],
    pub(crate) sources: &'a Sources,
    /// The same from another seed.
    pub(crate) second: Option<&'a Results>,
    /// Every figure that could be drawn, as SVG.
    pub(crate) figures: Vec<(&'a Figure, String)>,
}

/// The page, as HTML.
pub(crate) fn page(contents: &Contents<'_>) -> String {
    let figures =
        contents.figures.iter().map(|(figure, svg)| format!("<h2>{}</h2>{svg}<p>{}</p>", figure.title, figure.caption));
    format!("<!DOCTYPE html><meta charset=\"utf-8\"><title>policy-align</title>{}", figures.collect::<String>())
}
