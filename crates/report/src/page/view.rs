//! The grasp to walk around in: the robot, the wall and everybody's hand paths, drawn by a script of the page.

use maud::{Markup, PreEscaped, html};
use serde::Deserialize as _;
use serde_json::{Value, json};

use crate::figures::legs::{BONE, EYE, Leg, standing};
use crate::figures::{Figure, GraspPlayback, LEARNERS, Movement, Sources, stage, starts_shown};

/// The experiment beside which it stands.
pub(super) const EXPERIMENT: &str = "table2";

/// The figure data that it plays.
const DOCUMENT: &str = "grasp_playback";

/// Where on the page it is.
const PLACE: &str = "walk";

pub(super) const STYLE: &str = include_str!("../../../page/view/view.css");

/// In this order one script.
const SCRIPT: [&str; 13] = [
    include_str!("../../../page/view/matrix.js"),
    include_str!("../../../page/view/robot.js"),
    include_str!("../../../page/view/meshes.js"),
    include_str!("../../../page/view/shaders.js"),
    include_str!("../../../page/view/renderer.js"),
    include_str!("../../../page/view/camera.js"),
    include_str!("../../../page/view/gestures.js"),
    include_str!("../../../page/view/playback.js"),
    include_str!("../../../page/view/scene.js"),
    include_str!("../../../page/view/curves.js"),
    include_str!("../../../page/view/controls.js"),
    include_str!("../../../page/view/address.js"),
    include_str!("../../../page/view/view.js"),
];

const START: &str = "startView(document.getElementById(\"view\"), \
                     JSON.parse(document.getElementById(\"grasp-playback\").textContent));";

/// The view; nothing where a run has not computed what it plays. `figures` are those beside it: the first is what is
/// pointed to where it cannot be drawn.
pub(super) fn view(sources: &Sources, figures: &[&(Figure, String)]) -> Markup {
    let still = figures.first().map(|(figure, _)| format!("#figure-{}", figure.id));
    html! {
        @if let Some(Stage { held, playback }) = sources.documents.get(DOCUMENT).and_then(staged) {
            h3 #(PLACE) { "Walk around the robot" }
            p {
                "Both hands reach for the ball, led by the expert’s policy or by one that was learnt from demonstrations: past \
                 the wall that was in their way, past an obstacle that no demonstration shows, and with nothing in the way. " (held) " \
                 policy-align knows where to go from the first step on, but all demonstrations reach the ball from one side, so the potential fitted \
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

/// Parts of a unit to which positions are rounded: as many as the figure data have digits.
const PARTS: f64 = 1e4;

/// What the view plays.
struct Stage {
    /// What is to be said of the expert, where something stops it.
    held: String,
    playback: Value,
}

/// The figure data with the measures of what the figures draw around the robot, so that they are written once; legs apart
/// from other shapes, as they are bent where they are drawn; and of all starts those that are shown. Rows of positions are
/// steps from row to row, in whole parts of a unit, which takes half the room.
fn staged(playback: &Value) -> Option<Stage> {
    let data = GraspPlayback::deserialize(playback).ok()?;
    let starts = starts_shown(&data);
    let mut playback = playback.clone();
    let movements = playback["movements"].as_array_mut()?;
    movements.retain(|movement| starts.iter().any(|start| movement["start"] == *start));
    for movement in movements {
        for positions in ["joints", "palms"] {
            movement[positions] = steps(&movement[positions]);
        }
    }
    let legs = standing(&data.robot.shapes, &0);
    let trunk = data.robot.links.iter().position(|link| link.name == "torso")?;
    let places = |place: fn(&Leg) -> [f64; 3]| legs.iter().map(place).collect::<Vec<_>>();
    playback["robot"]["legs"] = json!({
        "trunk": trunk, "bone": BONE, "radius": legs.first()?.radius,
        "hips": places(|leg| leg.hip.into()), "ankles": places(|leg| leg.ankle.into()),
    });
    playback["robot"]["eye"] = json!(EYE);
    let mut place = 0..;
    let is_leg = |at: usize| legs.iter().any(|leg| leg.parts.contains(&at));
    playback["robot"]["shapes"].as_array_mut()?.retain(|_| !place.next().is_some_and(is_leg));
    playback["parts"] = json!(PARTS);
    playback["scene"]["stage"] = json!({ "plate_top": stage::PLATE_TOP, "board": stage::BOARD, "leg": stage::LEG });
    playback["starts"] = json!(starts);
    Some(Stage { held: held(&data, &starts), playback })
}

/// Why the expert stops, where it does: farther from its place at the end than a hand's breadth.
fn held(data: &GraspPlayback, starts: &[usize]) -> String {
    const STOPPED: f64 = 0.1;
    let stopped = |start: &usize| {
        let of = |m: &&Movement| m.constraint == "obstacle" && m.learner == "expert" && m.start == *start;
        let end = data.movements.iter().find(of).and_then(|movement| movement.palms.last());
        let away = |palm: (&[f64], &[f64])| palm.0.iter().zip(palm.1).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
        end.is_some_and(|end| end.chunks(3).zip(data.scene.target.chunks(3)).any(|palm| away(palm) > STOPPED))
    };
    let numbers: Vec<String> =
        starts.iter().enumerate().filter(|(_, start)| stopped(start)).map(|(at, _)| (at + 1).to_string()).collect();
    if numbers.is_empty() {
        return String::new();
    }
    let word = if numbers.len() == 1 { "start" } else { "starts" };
    format!(
        "From {word} {} the obstacle stops the expert too: its hand comes to stand before the plate with its place right \
         behind it, and the policy, which knows of no obstacle, wants nothing but straight on.",
        numbers.join(" and ")
    )
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
