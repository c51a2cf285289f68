//! The report as one self-contained page: style, script and pictures are embedded.

mod departures;
mod experiment;
mod facts;
mod fitted;
mod glance;
mod learners;
mod method;
mod pictures;
mod readings;
mod reservations;
mod table;
mod verdict_bar;
mod view;

use experiments::Experiment;
use experiments::results::Results;
use figures::{Figure, Sources};
use maud::{Markup, html};
use page::{Card, Document, Part};

use super::compared::{Compared, compared};
use crate::tally::Tally;

/// The figure that introduces the topic.
const OVERVIEW: &str = "overview";

/// The experiment that is shown first.
const FIRST: &str = "table1";

/// Contents of the page.
pub struct Contents<'a> {
    /// All known experiments.
    pub experiments: &'a [Experiment],
    /// The run.
    pub sources: &'a Sources,
    /// A run with another seed.
    pub second: Option<&'a Results>,
    /// Every figure whose data exist, as SVG.
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

/// A figure on a card; `heading` is the heading above, which the card does not repeat as its title.
fn card(figure: &Figure, svg: &str, heading: &str) -> Markup {
    let remark = figure.beside_paper.map(|text| ("Beside the paper's figure.", text));
    Card { id: figure.id, title: figure.title, caption: figure.caption, remark, svg }.under(heading)
}

/// All parts after the opening: the paper's first table, the robot, the fitted settings, all other experiments, the idea in
/// pictures, a glossary, and the method of measurement.
fn parts(contents: &Contents<'_>, all: &[Compared<'_>]) -> Vec<Part> {
    let experiment = |compared: &Compared<'_>| Part {
        id: compared.experiment.id.to_owned(),
        title: compared.experiment.title.to_owned(),
        body: experiment::section(compared, contents),
    };
    let printed = Tally::of(all.iter().map(|compared| (compared.experiment, compared.result))).total();
    let (first, others): (Vec<_>, Vec<_>) = all.iter().partition(|compared| compared.experiment.id == FIRST);
    let mut parts: Vec<Part> = first.into_iter().map(experiment).collect();
    parts.extend(view::part(contents));
    parts.extend(departures::part(contents, printed));
    parts.extend(others.into_iter().map(experiment));
    parts.extend(ideas(contents, all));
    parts.push(learners::part());
    parts.push(method::part(contents, all));
    parts
}

/// Figures that belong to no experiment of the run.
fn ideas(contents: &Contents<'_>, all: &[Compared<'_>]) -> Option<Part> {
    let shown = |id: Option<&str>| id.is_some_and(|id| all.iter().any(|compared| compared.experiment.id == id));
    let others: Vec<_> =
        contents.figures.iter().filter(|(figure, _)| !shown(figure.experiment) && figure.id != OVERVIEW).collect();
    let title = "The idea in pictures".to_owned();
    let body = html! {
        h2 { (title) }
        @for (figure, svg) in &others { (card(figure, svg, &title)) }
    };
    (!others.is_empty()).then(|| Part { id: "ideas".to_owned(), title, body })
}
