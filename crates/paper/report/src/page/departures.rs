//! Departures from the paper: fitted settings, and figures that differ.

use experiments::n_fitted;
use maud::{Markup, html};
use page::Part;

use super::{Contents, pictures};

/// The part about them; `None` if the run has no printed numbers.
pub(super) fn part(contents: &Contents<'_>, printed: usize) -> Option<Part> {
    let title = "What was fitted".to_owned();
    let body = html! { (fitted_settings()) (pictures::otherwise(contents)) };
    (printed > 0).then(|| Part { id: "fitted".to_owned(), title, body })
}

/// The fitted settings and other departures, in words.
fn fitted_settings() -> Markup {
    html! {
        h2 { "What was fitted" }
        ul .points {
            li {
                (n_fitted()) " numbers were chosen so that the printed ones come out: when the toy’s constraint changes, the held-out share, the passes over the \
                 samples (one for each input), the robots’ time step; for Table 2 the ball, the influence of the wall, the narrowest gap and two divisors of the inputs; for the 22 joints \
                 the attractor, a divisor and the cutoff of predictions. Everything else of the regression is a default of the LWPR library, and the potential is learnt as it is (23). \
                 Each experiment lists its settings, their class, and which verdicts change when one is a fifth smaller or larger. Robots, scenes and \
                 start postures are not published either and not counted."
            }
            li {
                "Not all numbers come out at once: in Table 2 the receptive fields that give the printed errors of the policy are too wide for the printed error of the \
                 potential."
            }
            li {
                "Table 2, where two hands reach for a ball through the gap between two plates, depends on them most: gaps narrower than 0.17 m are widened, \
                 which decides which of its numbers agree; the obstacle of its tests, which no demonstration shows, also stops the expert in half of \
                 the movements; movements last 50 s, the printed ones 2 s."
            }
        }
    }
}
