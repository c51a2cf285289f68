//! The report as one page that needs nothing else: style, script and pictures are in it.

mod emphasis;
mod experiment;
mod facts;
mod figure;
mod glance;
mod method;
mod pictures;
mod scale;
mod strip;
mod table;
mod verdict_bar;
mod view;

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::compared::{Compared, compared};
use crate::experiments::Experiment;
use crate::figures::{Figure, Sources};
use crate::results::Results;

const STYLE: &str = include_str!("../../../page/report.css");
const SCRIPT: &str = include_str!("../../../page/report.js");

/// What the page may do: show what is in it. Nothing is fetched.
const POLICY: &str = "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'";

/// The figure that says what it is about.
const OVERVIEW: &str = "overview";

/// What the page shows.
pub(crate) struct Contents<'a> {
    pub(crate) experiments: &'a [Experiment],
    pub(crate) sources: &'a Sources,
    /// The same from another seed.
    pub(crate) second: Option<&'a Results>,
    /// Every figure that could be drawn, as SVG.
    pub(crate) figures: Vec<(Figure, String)>,
}

/// A part of the page that can be gone to.
struct Part {
    id: String,
    title: String,
    body: Markup,
}

/// The page, as HTML.
pub(crate) fn page(contents: &Contents<'_>) -> String {
    let results = &contents.sources.results;
    let all = compared(contents.experiments, results, contents.second);
    let parts = parts(contents, &all);
    let title = "policy-align: the paper, computed again";
    let document = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                meta http-equiv="Content-Security-Policy" content=(POLICY);
                title { (title) }
                link rel="icon" href="data:,";
                style { (PreEscaped(STYLE)) (PreEscaped(view::STYLE)) }
            }
            body {
                a .skip href="#main" { "Skip to the results" }
                (navigation(&parts))
                main #main tabindex="-1" {
                    (glance::opening(contents, &all))
                    @for part in &parts { section id=(part.id) { (part.body) } }
                }
                (figure::enlarged())
                script type="module" { (PreEscaped(SCRIPT)) }
            }
        }
    };
    document.into_string()
}

/// All parts after the opening.
fn parts(contents: &Contents<'_>, all: &[Compared<'_>]) -> Vec<Part> {
    let experiment = |compared: &Compared<'_>| Part {
        id: compared.experiment.id.to_owned(),
        title: compared.experiment.title.to_owned(),
        body: experiment::section(compared, contents),
    };
    let mut parts: Vec<Part> = all.iter().map(experiment).collect();
    let shown = |id: Option<&str>| id.is_some_and(|id| all.iter().any(|compared| compared.experiment.id == id));
    let others: Vec<_> =
        contents.figures.iter().filter(|(figure, _)| !shown(figure.experiment) && figure.id != OVERVIEW).collect();
    if !others.is_empty() {
        let title = "The idea in pictures".to_owned();
        let body = html! {
            h2 { (title) }
            @for (figure, svg) in others { (figure::card(figure, svg, &title)) }
        };
        parts.push(Part { id: "ideas".to_owned(), title, body });
    }
    parts.push(method::part(&contents.sources.results));
    parts
}

fn navigation(parts: &[Part]) -> Markup {
    html! {
        nav aria-label="Contents" {
            p .name { "policy-align" }
            ol {
                li { a href="#glance" { "At a glance" } }
                @for part in parts { li { a href={ "#" (part.id) } { (part.title) } } }
            }
        }
    }
}
