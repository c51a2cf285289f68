//! The page that says what can be said before learning.

use maud::{Markup, html};
use nalgebra::DVector;
use page::{Card, Document, Part};
use plot::{Layer, Plane};
use policy_align::{Finding, Prepared, Verdict};
use text::plain;

use crate::cli::lines::{counted, short};
use crate::cli::pages::page_parts::{
    NUMBERS, STYLE, channels, decisions, direction, found, left_out, part, row, table,
};
use crate::cli::pages::picture::{SHOWN, with_unit};

/// Empty space around what is drawn, as a share of its range.
const MARGIN: f64 = 0.06;
/// Movements that are drawn, at most.
const DRAWN: usize = 200;

/// The page of recordings. `seen`: how evenly directions are seen, and the one seen least.
pub(crate) fn check_page(prepared: &Prepared, name: &str, seen: (f64, &DVector<f64>)) -> String {
    let title = format!("What was recorded in {name}");
    let opening = Part { id: "recorded".to_owned(), title: "Recorded".to_owned(), body: opening(prepared, &title) };
    let mut parts = Vec::new();
    if prepared.state.len() >= 2 {
        parts.push(part("movements", "Movements", &movements(prepared)));
    }
    parts.push(part("numbers", "Numbers", &numbers(prepared, seen)));
    parts.push(part("decisions", "Decisions", &decisions(&prepared.decisions)));
    let data = html! { (channels(&prepared.state)) (left_out(&prepared.left_out)) };
    parts.push(part("data", "Data", &data));
    plain(&Document { title: &title, name, opening, parts, style: STYLE }.html()).into_owned()
}

fn opening(prepared: &Prepared, title: &str) -> Markup {
    let worst = prepared.findings.iter().map(|finding| finding.verdict).max().unwrap_or(Verdict::Good);
    let (class, words) = match worst {
        Verdict::Good => ("conclusion", "All checks passed: these recordings can be learnt from."),
        Verdict::Doubtful => {
            ("conclusion doubtful", "Doubtful: read the findings before you learn from these recordings.")
        }
        Verdict::DoNotUse => ("conclusion wrong", "Do not learn from these recordings as they are."),
    };
    let mut findings: Vec<&Finding> = prepared.findings.iter().collect();
    findings.sort_by_key(|finding| std::cmp::Reverse(finding.verdict));
    html! {
        h1 #recorded { (title) }
        p class=(class) { (words) }
        @if !findings.is_empty() {
            ul .findings { @for finding in findings { (found(finding)) } }
        }
        p { (counted(prepared.demonstrations.n_trajectories(), "episode")) " with "
            (counted(prepared.demonstrations.n_samples(), "sample")) " of "
            (counted(prepared.state.len(), "channel")) "." }
    }
}

/// The first two channels against each other.
fn movements(prepared: &Prepared) -> Markup {
    let channels = [&prepared.state[0], &prepared.state[1]];
    let every = prepared.demonstrations.n_trajectories().div_ceil(DRAWN);
    let drawn = prepared.demonstrations.trajectories().iter().step_by(every);
    let path = |movement: &motion::Trajectory| {
        let place =
            |state: nalgebra::DVectorView<'_, f64>| (state[0] / channels[0].scale, state[1] / channels[1].scale);
        Layer::Path { points: movement.states().column_iter().map(place).collect(), stroke: SHOWN, label: None }
    };
    let start = |movement: &motion::Trajectory| {
        let state = movement.state(0);
        (state[0] / channels[0].scale, state[1] / channels[1].scale)
    };
    let starts = drawn.clone().map(start).collect();
    let mut layers: Vec<Layer> = drawn.map(path).collect();
    layers.push(Layer::Dots { points: starts, color: SHOWN.color, radius: 2.5 });
    let range = |axis: usize| {
        let width = (channels[axis].high - channels[axis].low).max(f64::MIN_POSITIVE);
        [channels[axis].low - MARGIN * width, channels[axis].high + MARGIN * width]
    };
    let plane = Plane {
        title: "The recorded movements".to_owned(),
        x_label: with_unit(channels[0]),
        y_label: with_unit(channels[1]),
        x: range(0),
        y: range(1),
        layers,
        size: Plane::SQUARE,
    };
    let svg = plot::Picture::rows(&[&[&plane]]).svg();
    let caption = format!("Movements in {} and {}; dots mark where they start.", channels[0].name, channels[1].name);
    Card { id: "movements", title: "Movements", caption: &caption, remark: None, svg: &svg }.under("Movements")
}

fn numbers(prepared: &Prepared, (coverage, least): (f64, &DVector<f64>)) -> Markup {
    let noise = &prepared.noise;
    let mut rows = vec![
        row("Seconds between samples", &short(prepared.time_step), "even, and short against the movement"),
        row("Share of noise in the squared steps", &short(noise.step_share), "below 0.1"),
    ];
    if let Some(share) = noise.velocity_share {
        rows.push(row("Share of noise in the squared velocities", &short(share), "below 0.01"));
    }
    for (channel, deviation) in prepared.state.iter().zip(noise.positions.iter().flatten()) {
        let what = format!("Noise of {}, standard deviation", channel.name);
        rows.push(row(&what, &short(deviation / channel.scale), "far below its range"));
    }
    rows.push(row(
        "Coverage of the least observed direction",
        &short(coverage),
        "above 0.1; 1 if all directions are alike",
    ));
    html! {
        (table(&NUMBERS, &rows))
        p { "Least observed direction: motion along " (direction(&prepared.state, least.as_slice())) "." }
    }
}
