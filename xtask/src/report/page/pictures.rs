//! Figures whose picture differs from the paper's, for the opening. Their captions say it in full.

use maud::{Markup, html};
use serde_json::Value;

use super::{Contents, figure};

/// What a full run shows and the paper's picture does not.
const OTHERWISE: [(&str, &str); 3] = [
    ("figure6_left", "the potential’s error φ is the lowest only with many movements, in the paper throughout."),
    (
        "figure6_right",
        "with much noise φ is no lower than Nπ; by the paper’s rule (9) 5\u{a0}% of noise leave nothing to learn.",
    ),
    ("figure9", "in (d) φ and π rise with the distance to less than the paper’s, in (e) they fall with the radius."),
];

/// The figures that are drawn and differ, each with what differs. A quick run is too coarse to tell.
pub(super) fn otherwise(contents: &Contents<'_>) -> Markup {
    let documents = &contents.sources.documents;
    let ends = documents.get("grasp_playback").and_then(|playback| ends(playback).map(|words| ("figure8", words)));
    let others = OTHERWISE.map(|(id, words)| (id, words.to_owned()));
    let said: Vec<_> = ends.into_iter().chain(others).collect();
    let words = |id: &str| said.iter().find(|(other, _)| *other == id).map(|(_, words)| words);
    let differ: Vec<_> = contents.figures.iter().filter_map(|(figure, _)| Some((figure, words(figure.id)?))).collect();
    html! {
        @if !contents.sources.results.quick && !differ.is_empty() {
            h2 .small { "Pictures that differ from the paper’s" }
            ul .differ {
                @for (figure, words) in differ {
                    li { a href={ "#figure-" (figure.id) } { (figure::name(figure)) } ": " (words) }
                }
            }
        }
    }
}

/// Where the hands of figure 8 end.
fn ends(playback: &Value) -> Option<String> {
    let [learnt, naive] = ["policy_align", "naive"].map(|learner| distance_at_end(playback, learner));
    Some(format!(
        "the hands of policy-align run past the ball and end {} from where they should take it (naive {}); the paper’s stay close to \
         the expert’s.",
        centimetres(learnt?),
        centimetres(naive?)
    ))
}

fn centimetres(metres: f64) -> String {
    format!("{:.0}\u{a0}cm", 100.0 * metres)
}

/// How far the palms of a learner's movements with nothing in the way are from their places in the end: the mean, metres.
fn distance_at_end(playback: &Value, learner: &str) -> Option<f64> {
    let numbers = |list: &Value| list.as_array()?.iter().map(Value::as_f64).collect::<Option<Vec<f64>>>();
    let target = numbers(&playback["scene"]["target"])?;
    let movements = playback["movements"].as_array()?.iter();
    let shown = movements.filter(|movement| movement["constraint"] == "none" && movement["learner"] == learner);
    let mut distances = vec![];
    for movement in shown {
        let end = numbers(movement["palms"].as_array()?.last()?)?;
        for (palm, place) in end.chunks(3).zip(target.chunks(3)) {
            distances.push(palm.iter().zip(place).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt());
        }
    }
    (!distances.is_empty()).then(|| distances.iter().sum::<f64>() / distances.len() as f64)
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn the_end_is_that_of_all_hands_with_nothing_in_the_way() {
        let movement = |constraint: &str, learner: &str, left: f64| {
            let palms = [[9.0, 0.0, 0.0, 9.0, 0.0, 0.0], [left, 0.0, 0.0, 1.0, 0.0, 0.3]];
            json!({ "constraint": constraint, "learner": learner, "palms": palms })
        };
        let movements = [("none", "policy_align", 1.1), ("gap", "policy_align", 7.0), ("none", "naive", 1.0)];
        let movements = movements.map(|(constraint, learner, left)| movement(constraint, learner, left));
        let playback = json!({ "scene": { "target": [1.0, 0.0, 0.0, 1.0, 0.0, 0.0] }, "movements": movements });
        let words = ends(&playback).unwrap();
        assert!(words.contains("end 20\u{a0}cm") && words.contains("(naive 15\u{a0}cm)"), "{words}");
        assert_eq!(ends(&json!({ "movements": [] })), None);
    }
}
