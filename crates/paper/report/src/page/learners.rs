//! The glossary: learners, errors, and names of rows and settings.

use experiments::Method;
use experiments::measure::Measure;
use figures::color_of;
use maud::{Markup, html};
use page::{Part, emphasised};

use crate::comparisons::CAUTION;
use crate::legend::{MEASURES, TERMS, names};

/// The part's address within the page.
pub(super) const ID: &str = "learners";

/// The glossary. The tables show the same explanations where the words occur.
pub(super) fn part() -> Part {
    let title = "Learners and errors".to_owned();
    let body = html! {
        h2 { (title) }
        dl .measures {
            @for method in Method::ALL { div { dt { (swatch(method)) (method.label()) } dd { (method.description()) } } }
        }
        p { (emphasised(CAUTION)) }
        h3 { "Errors" }
        p {
            "π is a policy, φ its potential, N the projector onto the null space of a constraint. Errors are mean squared errors as a share of the \
             variance of the true policy or potential: 0 is perfect, 1 is no better than the best constant. (A1) to (A4) and (9) are the paper’s equations."
        }
        dl .measures {
            @for (measures, meaning) in MEASURES { div { dt { (names(measures, Measure::label)) } dd { (meaning) } } }
        }
        h3 { "Names of rows and settings" }
        dl .measures { @for (names, meaning) in TERMS { div { dt { (names) } dd { (meaning) } } } }
    };
    Part { id: ID.to_owned(), title, body }
}

/// The learner's colour in the figures, if it has one.
fn swatch(method: Method) -> Markup {
    html! { @if let Some(color) = color_of(method) { span .swatch style={ "background:" (color) } {} } }
}
