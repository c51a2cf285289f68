//! Movements that were left out, and the speed that a policy learnt from the others predicts along them.

use maud::html;
use motion::{Policy as _, Trajectory};
use page::{Card, Part};
use plot::{Axis, Curve, Curves, Dash, Filling, Mark, Sign, Stroke};
use policy_align::{Learnt, Model, Prepared, StateChannel, without_movements};
use text::plain;

use crate::cli::pages::constraint_marks::as_recorded;
use crate::cli::pages::movements::simplified;
use crate::cli::pages::page_parts::part;

/// Samples of a movement that are drawn, at most.
const DRAWN: usize = 60;
/// How far curves of fewer points may be from these, as a share of the axes.
const FLAT: f64 = 4e-3;
/// Empty space above and below, as a share of the range.
const MARGIN: f64 = 0.08;
/// Fewer movements are too few to leave three out.
const LEAST: usize = 8;
/// Samples times the square of the dimension from which learning again takes longer than a page may.
const MOST: usize = 300_000;
const SIZE: (f64, f64) = (370.0, 280.0);
const TITLE: &str = "Left out and predicted";
const SEEN: Stroke = Stroke { color: "#56a0d3", width: 2.0, dash: Dash::Solid };
const PREDICTED: Stroke = Stroke { color: "#d55e00", width: 1.6, dash: Dash::Dashed };

/// Of the movements with the largest, the median and the least error when left out, the speed that was seen and the one that is
/// predicted along it from the others; none where there are too few to leave three out, where a context or a robot is learnt
/// with, or where learning again would take long.
pub(crate) fn left_out_part(model: &Model, prepared: &Prepared) -> Option<Part> {
    let effort = model.data.samples * model.state.len().pow(2);
    let of_robot = model.decisions.iter().any(|decision| ["metric", "task space"].contains(&decision.what.as_str()));
    if prepared.episodes.len() < LEAST || !model.context.is_empty() || of_robot || effort > MOST {
        return None;
    }
    let mut errors = model.trust.numbers.episode_errors.clone();
    errors.sort_by(|(_, a), (_, b)| b.total_cmp(a));
    let chosen = [("Largest", 0), ("Median", errors.len() / 2), ("Least", errors.len().checked_sub(1)?)];
    let chosen = chosen.map(|(name, at)| (name, errors[at]));
    let places: Vec<usize> = chosen.iter().map(|(_, (episode, _))| *episode).collect();
    let without = without_movements(model, prepared, &places).ok()?;
    let card = |&(name, (episode, _)): &(&str, (usize, f64))| {
        let movement = &prepared.demonstrations.trajectories()[episode];
        // Names may be long: they stand below the picture, where they are broken.
        let (title, own) = (format!("{name} error"), format!("Episode {}.", prepared.episodes[episode]));
        let svg = plot::Picture::rows(&[&[&curves(&without, movement, prepared, &title)]]).svg();
        let id = format!("left-out-{}", name.to_lowercase());
        Card { id: &id, title: &title, caption: &own, remark: None, svg: &svg }.under(&title)
    };
    let which = match model.learnt {
        Learnt::PolicyAlign(_) => "the Gaussian process that PolicyAlign's policy is compared with, learnt from",
        _ => "a policy learnt from",
    };
    let body = html! {
        p {
            "Blue: the speed of three movements along their own direction, as recorded. Orange and dashed: what " (which) " all other \
             movements predicts there. Where both agree, the movement shows nothing that the others do not. All three were left out \
             together; the numbers above leave out one after another, and are usually smaller."
        }
        div .small-multiples { @for of in &chosen { (card(of)) } }
    };
    Some(part("left-out", TITLE, &body))
}

/// Speed along a movement over time, seen and predicted, in units of the recording.
fn curves(without: &Model, movement: &Trajectory, prepared: &Prepared, title: &str) -> Curves {
    // Steps have a velocity each, between two samples.
    let velocities = movement.velocities().cloned().unwrap_or_else(|| movement.step_velocities());
    let (states, velocities) = (as_recorded(movement.states(), prepared), as_recorded(&velocities, prepared));
    let (policy, scales) = (without.policy(), without.scales());
    let n = velocities.ncols();
    let at = |sample: usize| {
        let state = match movement.velocities() {
            Some(_) => states.column(sample).into_owned(),
            None => 0.5 * (states.column(sample) + states.column(sample + 1)),
        };
        // Along the movement at right angles in the units in which the policy was learnt.
        let seen = velocities.column(sample).component_mul(&scales);
        let speed = seen.norm();
        let predicted = policy.action(state.as_view()).component_mul(&scales);
        let along = if speed == 0.0 { 0.0 } else { seen.dot(&predicted) / speed };
        (movement.seconds(0, sample), speed, along)
    };
    let points: Vec<(f64, f64, f64)> = (0..n).step_by(n.div_ceil(DRAWN).max(1)).map(at).collect();
    let values = points.iter().flat_map(|&(_, seen, along)| [seen, along]);
    let (low, high) = values.fold((0.0, 0.0), |(low, high): (f64, f64), value| (low.min(value), high.max(value)));
    let duration = points.last().map_or(1.0, |point| point.0).max(f64::MIN_POSITIVE);
    let (wide, tall) = (duration, (high - low).max(f64::MIN_POSITIVE));
    let curve = |stroke: Stroke, of: fn(&(f64, f64, f64)) -> f64| {
        let places: Vec<_> = points.iter().map(|point| (point.0 / wide, of(point) / tall)).collect();
        Curve {
            points: simplified(&places, FLAT).into_iter().map(|(x, y)| (wide * x, tall * y, 0.0)).collect(),
            stroke,
            sign: Some(Sign { mark: Mark::Circle, filling: Filling::Full }),
            name: String::new(),
        }
    };
    Curves {
        title: title.to_owned(),
        x_label: "time (s)".to_owned(),
        y_label: format!("speed ({})", unit(without)),
        x_axis: Axis::Linear,
        y_axis: Axis::Linear,
        x: [0.0, duration],
        y: [if low < 0.0 { low - MARGIN * tall } else { 0.0 }, if high > low { high + MARGIN * tall } else { 1.0 }],
        x_step: step(duration),
        lines: vec![curve(SEEN, |point| point.1), curve(PREDICTED, |point| point.2)],
        notes: vec![],
        room: 0.0,
        size: SIZE,
    }
}

/// The unit of a speed: that of all channels, where they have one and count alike.
fn unit(model: &Model) -> String {
    let first = &model.state[0];
    let alike = |of: fn(&StateChannel, &StateChannel) -> bool| model.state.iter().all(|channel| of(channel, first));
    match &first.unit {
        _ if !alike(|channel, _| channel.scale == 1.0) => "scaled units per s".to_owned(),
        Some(unit) if alike(|channel, first| channel.unit == first.unit) => format!("{}/s", plain(unit)),
        _ => "units per s".to_owned(),
    }
}

/// A round step that makes three to six parts of a range.
fn step(range: f64) -> f64 {
    let tenth = 10f64.powf((range / 3.0).log10().floor());
    [5.0, 2.0, 1.0].map(|of| of * tenth).into_iter().find(|step| range / step >= 2.0).unwrap_or(tenth)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_round_and_few() {
        for range in [0.013, 0.9, 1.0, 1.95, 3.0, 7.0, 60.0, 999.0] {
            let parts = range / step(range);
            assert!((2.0..=6.0).contains(&parts), "{range}: {parts}");
        }
    }
}
