//! The grasp to walk around in: the robot, the wall and everybody's hand paths, drawn by a script of the page.

use figures::view::{Staged, colors, staged};
use figures::{Figure, Sources};
use maud::{Markup, PreEscaped, html};

/// The experiment beside which it stands.
pub(super) const EXPERIMENT: &str = "table2";

/// The figure data that it plays.
const DOCUMENT: &str = "grasp_playback";

/// Where on the page it is.
const PLACE: &str = "walk";

pub(super) const STYLE: &str = include_str!("../../view/view.css");

/// In this order one script.
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

/// The view; nothing where a run has not computed what it plays. `figures` are those beside it: the first is what is
/// pointed to where it cannot be drawn.
pub(super) fn view(sources: &Sources, figures: &[&(Figure, String)]) -> Markup {
    let still = figures.first().map(|(figure, _)| format!("#figure-{}", figure.id));
    html! {
        @if let Some(Staged { stopped, playback }) = sources.documents.get(DOCUMENT).and_then(staged) {
            h3 #(PLACE) { "Walk around the robot" }
            p {
                "Both hands reach for the ball, led by the expert’s policy or by one that was learnt from demonstrations: past \
                 the wall that was in their way, past an obstacle that no demonstration shows, and with nothing in the way. " (held(&stopped)) " \
                 PolicyAlign knows where to go from the first step on, but all demonstrations reach the ball from one side, so the potential fitted \
                 there keeps sloping beyond it: its hands drift past the ball in the end, sometimes farther than the robot’s arms can follow. The slope GP goes where the \
                 expert goes: the expert’s potential is quadratic, and its families contain those. Table 2 compares \
                 actions at the samples of the demonstrations, not where movements end."
            }
            div #view data-still=[still] style=(colors()) {
                noscript { "The moving picture needs JavaScript; nothing else here does." }
            }
            script type="application/json" id="grasp-playback" { (PreEscaped(within_script(&playback.to_string()))) }
            script type="module" { (PreEscaped(SCRIPT.concat())) (PreEscaped(START)) }
        }
    }
}

/// Why the expert stops, where it does.
fn held(stopped: &[usize]) -> String {
    let numbers: Vec<String> = stopped.iter().map(usize::to_string).collect();
    if numbers.is_empty() {
        return String::new();
    }
    let word = if numbers.len() == 1 { "start" } else { "starts" };
    format!(
        "From {word} {} the obstacle stops the expert too: the plate stops its hand, whose place lies right \
         behind it, and the policy, which knows of no obstacle, keeps pushing straight on.",
        numbers.join(" and ")
    )
}

/// A way to the view, for the opening.
pub(super) fn way(sources: &Sources) -> Markup {
    html! {
        @if sources.documents.contains_key(DOCUMENT) {
            p .way { a href={ "#" (PLACE) } { "See the robot move, and walk around it" } }
        }
    }
}

/// JSON that cannot end the element that it stands in.
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
