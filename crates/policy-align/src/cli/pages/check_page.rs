//! The page of `check`: results that are available before learning.

use maud::{Markup, html};
use motion::{LeastSeen, Trajectory};
use nalgebra::DVectorView;
use page::{Card, Part};
use plot::Plane;
use policy_align::{Prepared, StateChannel, Verdict, direction_by_channels};

use crate::cli::lines::counted;
use crate::cli::pages::movements::{evenly, movements as draw};
use crate::cli::pages::numbers_table::{COVERAGE, Good, NOISE, numbers as table};
use crate::cli::pages::page_parts::{channels, decisions, left_out, opening, page, part};
use crate::cli::pages::picture::{DEMONSTRATED, MARKED, with_unit};

/// Margin around the drawing, as a share of its range.
const MARGIN: f64 = 0.06;
/// Largest number of movements in the picture.
const DRAWN: usize = 200;

const SENTENCES: [&str; 3] = [
    "All checks passed: these recordings can be learnt from.",
    "Doubtful: read the findings before you learn from these recordings.",
    "Do not learn from these recordings as they are.",
];

/// The page of recordings.
pub(crate) fn check_page(prepared: &Prepared, name: &str, least_seen: &LeastSeen) -> String {
    let title = format!("What was recorded in {name}");
    let data = html! {
        (counted(prepared.demonstrations.n_trajectories(), "episode")) " with "
        (counted(prepared.demonstrations.n_samples(), "sample")) " of "
        (counted(prepared.state.len(), "channel")) "."
    };
    let worst = Verdict::worst(&prepared.findings);
    let body = opening(("recorded", &title), (worst, SENTENCES), &prepared.findings, &data);
    let opening = Part { id: "recorded".to_owned(), title: "Recorded".to_owned(), body };
    let mut parts = Vec::new();
    if prepared.state.len() >= 2 {
        parts.push(part("movements", "Movements", &movements(prepared)));
    }
    parts.push(part("numbers", "Numbers", &numbers(prepared, least_seen)));
    parts.push(part("decisions", "Decisions", &decisions(&prepared.decisions)));
    let data = html! { (channels(&prepared.state)) (left_out(&prepared.left_out)) };
    parts.push(part("data", "Data", &data));
    page(&title, name, opening, parts)
}

/// The first two channels plotted against each other.
fn movements(prepared: &Prepared) -> Markup {
    let channels = [&prepared.state[0], &prepared.state[1]];
    let drawn = evenly(prepared.demonstrations.trajectories(), DRAWN);
    let place = |state: DVectorView<'_, f64>| (state[0] / channels[0].scale, state[1] / channels[1].scale);
    let path = |movement: &Trajectory| -> Vec<(f64, f64)> { movement.states().column_iter().map(place).collect() };
    let paths: Vec<_> = drawn.map(path).collect();
    let range = |axis: usize| {
        let width = (channels[axis].high - channels[axis].low).max(f64::MIN_POSITIVE);
        [channels[axis].low - MARGIN * width, channels[axis].high + MARGIN * width]
    };
    let range = [range(0), range(1)];
    let layers = draw(&paths, range, DEMONSTRATED, None, MARKED);
    let plane = Plane {
        title: "The recorded movements".to_owned(),
        x_label: with_unit(channels[0], 1.0),
        y_label: with_unit(channels[1], 1.0),
        x: range[0],
        y: range[1],
        layers,
        size: Plane::SQUARE,
    };
    let svg = plot::Picture::rows(&[&[&plane]]).svg();
    let caption = format!(
        "Movements in {} and {}; dots mark where they start, arrows which way they go.",
        channels[0].name, channels[1].name
    );
    Card { id: "movements", title: "Movements", caption: &caption, remark: None, svg: &svg }.under("Movements")
}

fn numbers(prepared: &Prepared, least_seen: &LeastSeen) -> Markup {
    let noise = &prepared.noise;
    let deviation = |(channel, deviation): (&StateChannel, &f64)| {
        let what = format!("Noise of {}, standard deviation", channel.name);
        (what, Some(deviation / channel.scale), Good::Words("far below its range"))
    };
    let positions = noise.positions.iter().flatten();
    let deviations: Vec<_> = prepared.state.iter().zip(positions).map(deviation).collect();
    let velocities = ("Share of noise in the squared velocities", noise.velocity_share, Good::Below(0.01));
    let rows = [
        ("Seconds between samples", Some(prepared.time_step), Good::Words("even, and short against the movement")),
        (NOISE.0, Some(noise.step_share), NOISE.1),
        velocities,
    ];
    let deviations = deviations.iter().map(|(what, value, good)| (what.as_str(), *value, *good));
    let rows = rows.into_iter().chain(deviations).chain([(COVERAGE.0, Some(least_seen.coverage()), COVERAGE.1)]);
    html! {
        (table(rows))
        p { "Least observed direction: motion along " (direction_by_channels(&least_seen.direction, &prepared.state)) "." }
    }
}
