//! Left-out movements, and the speed along them that the policy learnt from the others predicts.

use maud::html;
use motion::Trajectory;
use page::{Card, Part};
use plot::{Axis, Curve, Curves, Dash, Filling, Mark, Sign, Stroke};
use policy_align::{Learnt, Model, PredictedSpeed, Prepared, StateChannel};
use text::plain;

use crate::cli::pages::movements::simplified;
use crate::cli::pages::page_parts::part;

/// Largest number of rows of a movement in a curve.
const DRAWN: usize = 60;
/// Largest distance of a simplified curve from the original, as a share of the axes.
const FLAT: f64 = 4e-3;
/// Margin above and below, as a share of the range.
const MARGIN: f64 = 0.08;
/// Least number of movements for cross-validation.
const LEAST: usize = 3;
const SIZE: (f64, f64) = (370.0, 280.0);
const TITLE: &str = "Left out and predicted";
const SEEN: Stroke = Stroke { color: "#56a0d3", width: 2.0, dash: Dash::Solid };
const PREDICTED: Stroke = Stroke { color: "#d55e00", width: 1.6, dash: Dash::Dashed };

/// For the movements with the largest, the median and the least left-out error: the observed speed, and the speed along the
/// movement predicted from all others. `None` without cross-validation, or if the parts along the motion are not known.
pub(crate) fn left_out_part(model: &Model, prepared: &Prepared) -> Option<Part> {
    if prepared.episodes.len() < LEAST {
        return None;
    }
    let mut errors = model.trust.numbers.episode_errors.clone();
    errors.sort_by(|(_, a), (_, b)| b.total_cmp(a));
    let chosen = [("Largest", 0), ("Median", errors.len() / 2), ("Least", errors.len().checked_sub(1)?)];
    let drawn = chosen.map(|(name, at)| {
        let episode = errors[at].0;
        let rows: Vec<&PredictedSpeed> = model.predicted.iter().filter(|row| row.index.trajectory == episode).collect();
        (name, episode, rows)
    });
    if drawn.iter().any(|(.., rows)| rows.len() < 2) {
        return None;
    }
    let card = |(name, episode, rows): &(&str, usize, Vec<&PredictedSpeed>)| {
        let movement = &prepared.demonstrations.trajectories()[*episode];
        // Names may be long, so they are placed below the picture, where they can be wrapped.
        let (title, own) = (format!("{name} error"), format!("Episode {}.", prepared.episodes[*episode]));
        let svg = plot::Picture::rows(&[&[&curves(model, movement, rows, &title)]]).svg();
        let id = format!("left-out-{}", name.to_lowercase());
        Card { id: &id, title: &title, caption: &own, remark: None, svg: &svg }.under(&title)
    };
    let which = match model.learnt {
        Learnt::PolicyAlign(_) => "the Gaussian process that PolicyAlign's policy is compared with",
        _ => "the policy",
    };
    let body = html! {
        p {
            "Blue: the speed of three movements along their own direction, as learnt from. Orange and dashed: what " (which) " predicts \
             there if it learns from all other movements, with the same parameters. Where both agree, the movement shows nothing that the \
             others do not."
        }
        div .small-multiples { @for of in &drawn { (card(of)) } }
    };
    Some(part("left-out", TITLE, &body))
}

/// Speed along a movement over time, observed and predicted, in units of the model.
fn curves(model: &Model, movement: &Trajectory, rows: &[&PredictedSpeed], title: &str) -> Curves {
    let every = rows.len().div_ceil(DRAWN).max(1);
    let point = |row: &&PredictedSpeed| (movement.seconds(0, row.index.sample), row.seen, row.predicted);
    let points: Vec<(f64, f64, f64)> = rows.iter().step_by(every).map(point).collect();
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
        y_label: format!("speed ({})", unit(model)),
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

/// The unit of a speed, if all channels have the same unit and scale.
fn unit(model: &Model) -> String {
    let first = &model.state[0];
    let alike = |of: fn(&StateChannel, &StateChannel) -> bool| model.state.iter().all(|channel| of(channel, first));
    match &first.unit {
        _ if !alike(|channel, _| channel.scale == 1.0) => "scaled units per s".to_owned(),
        Some(unit) if alike(|channel, first| channel.unit == first.unit) => format!("{}/s", plain(unit)),
        _ => "units per s".to_owned(),
    }
}

/// A round step that divides a range into three to six parts.
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
