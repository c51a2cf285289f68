//! The 3-D view of the grasp: the robot, the wall and every learner's hand paths, drawn by a script of the page.

use figures::Sources;
use figures::view::{Staged, colors, staged};
use maud::{Markup, PreEscaped, html};
use page::Part;

use super::Contents;

/// The experiment that the view shows.
pub(super) const EXPERIMENT: &str = "table2";

/// The figure data that the view plays back.
const DOCUMENT: &str = "grasp_playback";

/// The view's address within the page.
const PLACE: &str = "walk";

pub(super) const STYLE: &str = include_str!("../../view/view.css");

/// Parts of the script, concatenated in this order.
const SCRIPT: [&str; 13] = [
    include_str!("../../view/matrix.js"),
    include_str!("../../view/robot.js"),
    include_str!("../../view/meshes.js"),
    include_str!("../../view/shaders.js"),
    include_str!("../../view/renderer.js"),
    include_str!("../../view/camera.js"),
    include_str!("../../view/gestures.js"),
    include_str!("../../view/playback.js"),
    include_str!("../../view/scene.js"),
    include_str!("../../view/curves.js"),
    include_str!("../../view/controls.js"),
    include_str!("../../view/address.js"),
    include_str!("../../view/view.js"),
];

const START: &str = "startView(document.getElementById(\"view\"), \
                     JSON.parse(document.getElementById(\"grasp-playback\").textContent));";

/// The view; `None` if the run has not computed its data. If a browser cannot draw the view, it refers to the
/// experiment's first figure.
pub(super) fn part(contents: &Contents<'_>) -> Option<Part> {
    let Staged { stopped, playback } = contents.sources.documents.get(DOCUMENT).and_then(staged)?;
    let still = contents.figures.iter().find(|(figure, _)| figure.experiment == Some(EXPERIMENT));
    let still = still.map(|(figure, _)| format!("#figure-{}", figure.id));
    let title = "Walk around the robot".to_owned();
    let body = html! {
            h2 { (title) }
            p {
                "Both hands reach for the ball, guided by the expert’s policy or by a learnt one: through the gap in the wall of the demonstrations, past \
                 an obstacle that no demonstration contains, and unconstrained. " (held(&stopped)) " \
                 PolicyAlign heads for the ball from the first step. All demonstrations reach the ball from one side, so its potential \
                 keeps sloping beyond the ball: the hands drift past it, sometimes farther than the robot’s arms can follow. The slope GP follows \
                 the expert, whose potential is quadratic and so among the functions that it assumes. Table 2 compares \
                 actions at the samples of the demonstrations, not where movements end."
            }
            div #view data-still=[still] style=(colors()) {
                noscript { "The moving picture needs JavaScript; nothing else here does." }
            }
            script type="application/json" id="grasp-playback" { (PreEscaped(within_script(&playback.to_string()))) }
            script type="module" { (PreEscaped(SCRIPT.concat())) (PreEscaped(START)) }
    };
    Some(Part { id: PLACE.to_owned(), title, body })
}

/// The explanation of why the expert stops from some starts.
fn held(stopped: &[usize]) -> String {
    let numbers: Vec<String> = stopped.iter().map(usize::to_string).collect();
    if numbers.is_empty() {
        return String::new();
    }
    let word = if numbers.len() == 1 { "start" } else { "starts" };
    format!(
        "From {word} {} the obstacle stops the expert too: the place of its hand lies right behind the plate, and the \
         policy, which ignores obstacles, keeps pushing straight on.",
        numbers.join(" and ")
    )
}

/// A link to the view.
pub(super) fn way(sources: &Sources) -> Markup {
    html! {
        @if sources.documents.contains_key(DOCUMENT) {
            p .way { a href={ "#" (PLACE) } { "See the robot move, and walk around it" } }
        }
    }
}

/// Escapes JSON so that it cannot close the `script` element around it.
fn within_script(json: &str) -> String {
    json.replace('<', "\\u003c")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn data_cannot_end_their_element() {
        let data = serde_json::json!({ "name": "</script><!--", "x": [1.5, -2e-9] });
        let text = within_script(&data.to_string());
        assert!(!text.contains('<'), "{text}");
        assert_eq!(serde_json::from_str::<serde_json::Value>(&text).unwrap(), data);
    }
}
