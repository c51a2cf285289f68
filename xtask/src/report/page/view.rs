//! The grasp to walk around in: the robot, the wall and everybody's hand paths, drawn by a script of the page.

use maud::{Markup, PreEscaped, html};
use serde_json::{Value, json};

use crate::figures::{Figure, LEARNERS, Sources, stage};

/// The experiment beside which it stands.
pub(super) const EXPERIMENT: &str = "table2";

/// The figure data that it plays.
const DOCUMENT: &str = "grasp_playback";

/// Where on the page it is.
const PLACE: &str = "walk";

pub(super) const STYLE: &str = include_str!("../../../page/view/view.css");

/// In this order one script.
const SCRIPT: [&str; 11] = [
    include_str!("../../../page/view/matrix.js"),
    include_str!("../../../page/view/robot.js"),
    include_str!("../../../page/view/meshes.js"),
    include_str!("../../../page/view/shaders.js"),
    include_str!("../../../page/view/renderer.js"),
    include_str!("../../../page/view/camera.js"),
    include_str!("../../../page/view/gestures.js"),
    include_str!("../../../page/view/playback.js"),
    include_str!("../../../page/view/scene.js"),
    include_str!("../../../page/view/controls.js"),
    include_str!("../../../page/view/view.js"),
];

const START: &str = "startView(document.getElementById(\"view\"), \
                     JSON.parse(document.getElementById(\"grasp-playback\").textContent));";

/// The view; nothing where a run has not computed what it plays. `figures` are those beside it: the first is what is
/// pointed to where it cannot be drawn.
pub(super) fn view(sources: &Sources, figures: &[&(Figure, String)]) -> Markup {
    let still = figures.first().map(|(figure, _)| format!("#figure-{}", figure.id));
    html! {
        @if let Some(playback) = sources.documents.get(DOCUMENT) {
            h3 #(PLACE) { "Walk around the robot" }
            p {
                "Both hands reach for the ball, led by the expert’s policy or by one that was learnt from demonstrations: past \
                 the wall that was in their way, past an obstacle that no demonstration shows (which stops one of the expert’s own hands from starts 2 and 3), and with nothing in the way. \
                 policy-align knows where to go from the first step on, but where the slope is nearly none its regression displaces the \
                 goal: its hands drift past the ball in the end, sometimes farther than the robot’s arms can follow. The slope GP goes where the \
                 expert goes: the expert’s potential is quadratic, and its families contain those. Table 2 compares \
                 actions at the samples of the demonstrations, not where movements end."
            }
            div #view data-still=[still] style=(colors()) {
                noscript { "The moving picture needs JavaScript; nothing else here does." }
            }
            script type="application/json" id="grasp-playback" { (PreEscaped(within_script(&staged(playback).to_string()))) }
            script type="module" { (PreEscaped(SCRIPT.concat())) (PreEscaped(START)) }
        }
    }
}

/// Parts of a unit to which positions are told: as many as the figure data have digits.
const PARTS: f64 = 1e4;

/// The figure data with the measures of what the figures draw around the robot, so that they are written once; rows of
/// positions as steps from row to row, in whole parts of a unit, which takes half the room.
fn staged(playback: &Value) -> Value {
    let mut playback = playback.clone();
    for movement in playback["movements"].as_array_mut().into_iter().flatten() {
        for positions in ["joints", "palms"] {
            movement[positions] = steps(&movement[positions]);
        }
    }
    playback["parts"] = json!(PARTS);
    playback["scene"]["stage"] = json!({ "plate_top": stage::PLATE_TOP, "board": stage::BOARD, "leg": stage::LEG });
    playback
}

/// Differences of successive rows, the first from 0.
fn steps(rows: &Value) -> Value {
    let parts = |row: &Value| -> Vec<i64> {
        let row = row.as_array().into_iter().flatten();
        row.map(|value| (value.as_f64().unwrap_or_default() * PARTS).round() as i64).collect()
    };
    let mut before = Vec::new();
    let rows = rows.as_array().into_iter().flatten().map(|row| {
        let row = parts(row);
        let step: Vec<i64> = row.iter().enumerate().map(|(k, part)| part - before.get(k).unwrap_or(&0)).collect();
        before = row;
        step
    });
    json!(rows.collect::<Vec<_>>())
}

/// The figures' colours, for the style sheet of the view.
fn colors() -> String {
    let things = [("ball", stage::BALL), ("table", stage::TABLE), ("plate", stage::PLATE)];
    let all = things.into_iter().chain(LEARNERS.map(|(id, who)| (id, who.color())));
    all.map(|(name, color)| format!("--figure-{}:{color}", name.replace('_', "-"))).collect::<Vec<_>>().join(";")
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
