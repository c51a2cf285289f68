//! The report as one page that needs nothing else: style, script and pictures are in it.

mod experiment;
mod facts;
mod fitted;
mod glance;
mod learners;
mod method;
mod pictures;
mod readings;
mod table;
mod verdict_bar;
mod view;

use experiments::Experiment;
use experiments::results::Results;
use figures::{Figure, Sources};
use maud::{Markup, html};
use page::{Card, Document, Part};

use super::compared::{Compared, compared};

/// The figure that says what it is about.
const OVERVIEW: &str = "overview";

/// What the page shows.
pub struct Contents<'a> {
    /// All that there are.
    pub experiments: &'a [Experiment],
    /// The run.
    pub sources: &'a Sources,
    /// The same from another seed.
    pub second: Option<&'a Results>,
    /// Every figure that could be drawn, as SVG.
    pub figures: Vec<(Figure, String)>,
}

/// The page, as HTML.
pub fn page(contents: &Contents<'_>) -> String {
    let results = &contents.sources.results;
    let all = compared(contents.experiments, results, contents.second);
    let body = glance::opening(contents, &all);
    let opening = Part { id: "glance".to_owned(), title: "At a glance".to_owned(), body };
    let (title, name) = ("policy-align: the paper, computed again", "policy-align");
    Document { title, name, opening, parts: parts(contents, &all), style: view::STYLE }.html()
}

/// A figure on a card, under a heading that may have said its title.
fn card(figure: &Figure, svg: &str, heading: &str) -> Markup {
    let remark = figure.beside_paper.map(|text| ("Beside the paper's figure.", text));
    Card { id: figure.id, title: figure.title, caption: figure.caption, remark, svg }.under(heading)
}

/// All parts after the opening: what it is about, who learns, what came of it, how it was measured.
fn parts(contents: &Contents<'_>, all: &[Compared<'_>]) -> Vec<Part> {
    let experiment = |compared: &Compared<'_>| Part {
        id: compared.experiment.id.to_owned(),
        title: compared.experiment.title.to_owned(),
        body: experiment::section(compared, contents),
    };
    let mut parts = Vec::new();
    let shown = |id: Option<&str>| id.is_some_and(|id| all.iter().any(|compared| compared.experiment.id == id));
    let others: Vec<_> =
        contents.figures.iter().filter(|(figure, _)| !shown(figure.experiment) && figure.id != OVERVIEW).collect();
    if !others.is_empty() {
        let title = "The idea in pictures".to_owned();
        let body = html! {
            h2 { (title) }
            @for (figure, svg) in others { (card(figure, svg, &title)) }
        };
        parts.push(Part { id: "ideas".to_owned(), title, body });
    }
    parts.push(learners::part());
    parts.extend(all.iter().map(experiment));
    parts.push(method::part(&contents.sources.results));
    parts
}
