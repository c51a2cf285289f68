//! The page that says how far to trust a policy.

use maud::{Markup, html};
use motion::Demonstrations;
use nalgebra::DMatrix;
use page::{Card, Document, Part};
use policy_align::{Decision, Finding, LeftOutEpisode, Model, StateChannel, TrustNumbers, Verdict};

use super::info::learner;
use super::lines::{counted, list, short};
use super::picture::Picture;

pub(crate) const STYLE: &str = include_str!("trust_page.css");

/// The page of a model, with a picture of what was shown if it is given, in the units of the learner.
pub(crate) fn trust_page(model: &Model, name: &str, shown: Option<&Demonstrations>) -> String {
    let title = format!("How far to trust {name}");
    let opening = Part { id: "verdict".to_owned(), title: "Verdict".to_owned(), body: opening(model, &title) };
    let mut parts = Vec::new();
    if model.state.len() >= 2 {
        parts.push(part("field", "What was learnt", &field(model, shown)));
    }
    parts.push(part("numbers", "Numbers", &numbers(model)));
    parts.push(part("decisions", "What was decided", &decisions(&model.decisions)));
    parts.push(part("data", "Data", &data(model)));
    Document { title: &title, name, opening, parts, style: STYLE }.html()
}

pub(crate) fn part(id: &str, title: &str, body: &Markup) -> Part {
    Part { id: id.to_owned(), title: title.to_owned(), body: html! { h2 { (title) } (body) } }
}

fn opening(model: &Model, title: &str) -> Markup {
    let (class, words) = match model.trust.verdict {
        Verdict::Good => ("verdict", "Good: nothing was found against it."),
        Verdict::Doubtful => ("verdict doubtful", "Doubtful: look at what follows before you use it."),
        Verdict::DoNotUse => ("verdict wrong", "Do not use: it is wrong, or nothing tells whether it is right."),
    };
    html! {
        h1 #verdict { (title) }
        p class=(class) { (words) }
        @if !model.trust.findings.is_empty() {
            ul .findings { @for finding in &model.trust.findings { (found(finding)) } }
        }
        p { "Learnt by " (learner(model)) ", from " (counted(model.data.episodes, "episode")) " with "
            (counted(model.data.samples, "sample")) ". All this is found without knowing the true policy: a "
            "constraint that is the same in every demonstration cannot be seen in data." }
    }
}

pub(crate) fn found(finding: &Finding) -> Markup {
    let label = match finding.verdict {
        Verdict::Good => "Remark",
        Verdict::Doubtful => "Doubtful",
        Verdict::DoNotUse => "Do not use",
    };
    html! { li { b { (label) ": " } (finding.what) ". " span .next { "Next: " (finding.next) "." } } }
}

fn field(model: &Model, shown: Option<&Demonstrations>) -> Markup {
    let movements = shown.map_or_else(Vec::new, |shown| {
        let unscaled = |states: &DMatrix<f64>| {
            DMatrix::from_fn(states.nrows(), states.ncols(), |k, i| states[(k, i)] / model.state[k].scale)
        };
        shown.trajectories().iter().map(|movement| unscaled(movement.states())).collect()
    });
    let plane = Picture::of(model, [0, 1], movements, vec![]).plane();
    let svg = plot::Picture::rows(&[&[&plane]]).svg();
    let rest = if model.state.len() > 2 { " All other channels are at their median." } else { "" };
    let caption = format!(
        "Arrows are the learnt action, grey lines its potential where it has one, blue lines what was shown. Grey areas \
         are outside of what was shown: nothing is known there.{rest}"
    );
    Card { id: "field", title: "What was learnt", caption: &caption, remark: None, svg: &svg }.under("What was learnt")
}

/// A row: what it is, its value, what it should be.
pub(crate) fn row(what: &str, value: &str, good: &str) -> Markup {
    html! { tr { td { (what) } td .value { (value) } td { (good) } } }
}

fn numbers(model: &Model) -> Markup {
    let numbers = &model.trust.numbers;
    html! {
        p { "Errors are squared and shares of the policy's own squares: 0 is exact, 1 is as good as standing still." }
        table .numbers {
            thead { tr { th { "What" } th .value { "Value" } th { "Good is" } } }
            tbody {
                (row("Error along movements left out", &short(numbers.held_out_error), &below(TrustNumbers::GOOD_HELD_OUT_ERROR)))
                (row("The same of averaging (the direct learner)", &short(numbers.held_out_error_direct), "for comparison"))
                (row("Error of the direct learner in all directions", &short(numbers.direct_error), "for comparison"))
                (row("Error that the policy expects of itself", &short(numbers.expected_error), &below(TrustNumbers::GOOD_EXPECTED_ERROR)))
                (row("Difference of slope and direct policy", &short(numbers.gap), "large where constraints acted"))
                @if let Some((_, error)) = numbers.episode_errors.iter().max_by(|a, b| a.1.total_cmp(&b.1)) {
                    (row("The worst movement left out", &short(*error), "not far from the others"))
                }
                @if let Some(halves) = numbers.halves {
                    (row("Difference of policies of both halves of the movements", &short(halves), &below(TrustNumbers::GOOD_HALVES)))
                }
                (row("Squared errors over those expected", &short(numbers.z_squared), "below 4"))
                (row("Directions seen, the least of them", &short(numbers.direction_coverage), "above 0.1; 1 if all alike"))
                (row("Share of rotation in the policy", &short(numbers.rotation_share), "0 for a potential"))
                (row("Free movements that leave what was shown", &short(numbers.leaving), "0"))
                (row("Share of noise in the squared steps", &short(numbers.step_noise), "below 0.1"))
                (aligned(numbers))
            }
        }
        p { "Seen least: " (direction(&model.state, &numbers.unseen_direction)) ". Known least: "
            (direction(&model.state, &numbers.least_known_direction)) "." }
    }
}

fn aligned(numbers: &TrustNumbers) -> Markup {
    let Some(aligned) = &numbers.aligned else { return html! {} };
    html! {
        (row("Movements aligned", &format!("{} of {}", aligned.kept, aligned.kept + aligned.discarded), "nearly all"))
        (row("Disagreement of aligned potentials", &short(aligned.residual), "below 0.1"))
        (row("Samples left out that nothing is known of", &short(aligned.unsupported), "below 0.05"))
        (row("Difference from the Gaussian process", &short(aligned.difference), "below 0.1"))
    }
}

/// What verdicts ask for.
fn below(threshold: f64) -> String {
    format!("below {threshold}")
}

/// A direction, by the channels that it mostly has.
pub(crate) fn direction(state: &[StateChannel], direction: &[f64]) -> String {
    let mut parts: Vec<(f64, &str)> =
        direction.iter().copied().zip(state.iter().map(|channel| channel.name.as_str())).collect();
    parts.sort_by(|a, b| b.0.abs().total_cmp(&a.0.abs()));
    let listed: Vec<String> = parts.iter().take(3).map(|(part, name)| format!("{} {name}", short(*part))).collect();
    listed.join(", ")
}

pub(crate) fn decisions(decisions: &[Decision]) -> Markup {
    html! {
        p { "Everything that was decided for you, and the flag that decides otherwise." }
        table .numbers {
            thead { tr { th { "What" } th { "Decided" } th { "Why" } th { "Flag" } } }
            tbody {
                @for decision in decisions {
                    tr {
                        td { (decision.what) } td { (decision.value) } td { (decision.why) }
                        td { code { (decision.flag) } }
                    }
                }
            }
        }
    }
}

fn data(model: &Model) -> Markup {
    let files: Vec<String> =
        model.data.files.iter().map(|file| format!("{}, SHA-256 {:.16}", file.name, file.sha256)).collect();
    html! {
        (channels(&model.state))
        (left_out(&model.data.left_out))
        p .where { "Files: "
        (files.join("; ")) ". " (model.made_by.program) ", " (model.made_by.time) ", seed " (model.seed) "." }
    }
}

/// Names, units and ranges.
pub(crate) fn channels(state: &[StateChannel]) -> Markup {
    html! {
        table .numbers {
            thead { tr { th { "Channel" } th { "Unit" } th .value { "Least, median, largest" } th .value { "Scale" } } }
            tbody {
                @for channel in state {
                    tr {
                        td { (channel.name) }
                        td { (channel.unit.as_deref().unwrap_or("not given")) }
                        td .value { (list([channel.low, channel.median, channel.high])) }
                        td .value { (short(channel.scale)) }
                    }
                }
            }
        }
    }
}

/// Episodes that are not learnt from.
pub(crate) fn left_out(episodes: &[LeftOutEpisode]) -> Markup {
    let listed: Vec<String> = episodes.iter().map(|left| format!("{} ({})", left.episode, left.why)).collect();
    html! { @if !listed.is_empty() { p { "Left out: " (listed.join(", ")) "." } } }
}
