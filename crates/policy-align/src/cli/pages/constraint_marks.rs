//! Marks of the estimated constraints in a picture of two channels: the line that each allows, and its normal.

use nalgebra::{DMatrix, DVector};
use plot::{Dash, Layer, Stroke};
use policy_align::gp::Acting;
use policy_align::{ConstraintOn, ConstraintStretch, Prepared, StateChannel};

/// Largest number of constraints in the picture, evenly selected.
const DRAWN: usize = 60;
/// Half the length of a line, and the length of a normal in the plane of the picture, as a share of the picture's smaller side.
const LENGTH: f64 = 0.04;
/// Nothing is drawn if the normal's part in the plane of the picture is smaller than this: the constraint is nearly parallel to the
/// plane.
const LEAST_PART: f64 = 0.2;
const COLOR: &str = "#7b3294";
const KEPT: Stroke = Stroke { color: COLOR, width: 1.8, dash: Dash::Solid };
const MOVING: Stroke = Stroke { color: COLOR, width: 1.8, dash: Dash::Dashed };

/// A constraint on the channels, and the state half way along its stretch, (n), in units of the recording.
pub(crate) struct Held {
    state: DVector<f64>,
    normals: Vec<DVector<f64>>,
    /// For each row, whether its right-hand side differs from 0.
    moves: Vec<bool>,
}

/// The points of a line, and whether the constraint moves.
type Line = (Vec<(f64, f64)>, bool);

/// The constraints on channels among these stretches, at most as many as are drawn.
pub(crate) fn held(found: &[ConstraintStretch], prepared: &Prepared) -> Vec<Held> {
    let on_channels =
        |stretch: &&ConstraintStretch| stretch.acting == Acting::Constraint && stretch.on == ConstraintOn::Channels;
    let all: Vec<&ConstraintStretch> = found.iter().filter(on_channels).collect();
    let as_held = |stretch: &&ConstraintStretch| {
        let episode = prepared.episodes.iter().position(|name| *name == stretch.episode)?;
        let movement = &prepared.demonstrations.trajectories()[episode];
        let last = movement.n_samples() - 1;
        let at = middle(movement.states(), (stretch.samples.0.min(last), stretch.samples.1.min(last)));
        let scale = |k: usize| prepared.state[k].scale;
        Some(Held {
            state: DVector::from_fn(prepared.state.len(), |k, _| movement.states()[(k, at)] / scale(k)),
            normals: stretch.normals.iter().map(|normal| DVector::from_column_slice(normal)).collect(),
            moves: stretch.speeds.iter().map(|speed| *speed != 0.0).collect(),
        })
    };
    all.iter().step_by(all.len().div_ceil(DRAWN).max(1)).filter_map(as_held).collect()
}

/// The sample half way along the path between two samples. The middle sample would not do: movements that come to rest have most
/// samples there.
fn middle(states: &DMatrix<f64>, (first, last): (usize, usize)) -> usize {
    let step = |at: usize| (states.column(at + 1) - states.column(at)).norm();
    let half = 0.5 * (first..last).map(step).sum::<f64>();
    let mut gone = 0.0;
    (first..last)
        .find(|&at| {
            gone += step(at);
            gone >= half
        })
        .unwrap_or(first)
}

/// The prepared movements, (n, N) each, in units of the recording.
pub(crate) fn recorded(prepared: &Prepared) -> Vec<DMatrix<f64>> {
    let movements = prepared.demonstrations.trajectories().iter();
    movements.map(|movement| as_recorded(movement.states(), prepared)).collect()
}

/// States or velocities of a prepared movement, (n, N), in units of the recording.
pub(crate) fn as_recorded(values: &DMatrix<f64>, prepared: &Prepared) -> DMatrix<f64> {
    // Not the model's scales, which it may have learnt.
    DMatrix::from_fn(values.nrows(), values.ncols(), |k, i| values[(k, i)] / prepared.state[k].scale)
}

/// Marks constraints at their states: the line in which a constraint of one row intersects the plane of the picture, and the
/// components of all normals in that plane. Channels are multiplied by their `factors`; `side` is the smaller side of the picture.
pub(crate) fn marks(
    held: &[Held],
    channels: &[StateChannel],
    dims: [usize; 2],
    factors: [f64; 2],
    side: f64,
) -> Vec<Layer> {
    let length = LENGTH * side;
    let (mut lines, mut arrows) = (Vec::new(), Vec::new());
    for Held { state, normals, moves } in held {
        let (x, y) = (factors[0] * state[dims[0]], factors[1] * state[dims[1]]);
        for (normal, &moves) in normals.iter().zip(moves) {
            let (u, v) = in_picture(normal, channels, dims);
            let part = u.hypot(v);
            if part < LEAST_PART {
                continue;
            }
            if normals.len() == 1 {
                let (along, up) = (-v / part * length, u / part * length);
                lines.push((vec![(x - along, y - up), (x + along, y + up)], moves));
            }
            arrows.push((x, y, u * length, v * length));
        }
    }
    let labels = [(false, "kept by a constraint"), (true, "kept while it moves")];
    let first = |moves: bool| lines.iter().position(|(_, of)| *of == moves);
    let label =
        |at: usize| labels.iter().find(|(moves, _)| first(*moves) == Some(at)).map(|(_, name)| (*name).to_owned());
    let path = |(at, (points, moves)): (usize, &Line)| Layer::Path {
        points: points.clone(),
        stroke: if *moves { MOVING } else { KEPT },
        label: label(at),
    };
    let mut layers: Vec<Layer> = lines.iter().enumerate().map(path).collect();
    if !arrows.is_empty() {
        let label = Some("its normal".to_owned());
        layers.push(Layer::Arrows { arrows, color: COLOR, scale: 1.0, width: 1.1, label });
    }
    layers
}

/// The components of a row of A, (n) in units of the recording, in the plane of the picture, divided by the row's length. Lengths
/// are in the units in which constraints project orthogonally.
fn in_picture(normal: &DVector<f64>, channels: &[StateChannel], dims: [usize; 2]) -> (f64, f64) {
    let scaled = DVector::from_fn(normal.len(), |k, _| normal[k] / channels[k].scale);
    let length = scaled.norm();
    (scaled[dims[0]] / length, scaled[dims[1]] / length)
}

#[cfg(test)]
mod tests {
    use policy_align::StateChannel;
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// Up to one step, half of the path lies before the middle, however the samples are distributed along it.
        #[test]
        fn the_middle_is_half_way(steps in prop::collection::vec(0.0..1.0f64, 1..40), first in 0usize..40, last in 0usize..40) {
            let (first, last) = (first.min(last).min(steps.len()), first.max(last).min(steps.len()));
            let places: Vec<f64> = std::iter::once(0.0).chain(steps.iter().scan(0.0, |x, step| { *x += step; Some(*x) })).collect();
            let states = DMatrix::from_fn(2, places.len(), |k, i| (k as f64 + 1.0) * places[i]);
            let at = middle(&states, (first, last));
            prop_assert!((first..=last).contains(&at));
            let half = 0.5 * (places[first] + places[last]);
            prop_assert!(places[at] <= half + 1e-9 && (at == last || places[at + 1] >= half - 1e-9));
        }

        /// A line keeps the constraint, is perpendicular to its normal, and passes through the place. A normal that is perpendicular
        /// to the plane of the picture is not drawn.
        #[test]
        fn lines_keep_the_constraint(normal in prop::array::uniform3(-1.0..1.0f64), place in prop::array::uniform3(-2.0..2.0f64), moves: bool) {
            let normal = DVector::from_column_slice(&normal);
            prop_assume!(normal.norm() > 0.1);
            let normal = normal.normalize();
            let channel = |name: &str| -> StateChannel {
                serde_json::from_value(serde_json::json!({
                    "name": name, "unit": null, "scale": 1.0, "low": -1.0, "median": 0.0, "high": 1.0
                })).expect("a channel")
            };
            let channels = ["x", "y", "z"].map(channel);
            let state = DVector::from_column_slice(&place);
            let held = [Held { state: state.clone(), normals: vec![normal.clone()], moves: vec![moves] }];
            let layers = marks(&held, &channels, [0, 1], [1.0; 2], 1.0);
            let part = normal[0].hypot(normal[1]);
            prop_assert_eq!(layers.len(), if part < LEAST_PART { 0 } else { 2 });
            for layer in layers {
                match layer {
                    Layer::Path { points, stroke, .. } => {
                        prop_assert_eq!(stroke.dash == Dash::Dashed, moves);
                        for (x, y) in points {
                            let on = normal[0] * (x - state[0]) + normal[1] * (y - state[1]);
                            prop_assert!(on.abs() < 1e-12 && (x - state[0]).hypot(y - state[1]) - LENGTH < 1e-12);
                        }
                    }
                    Layer::Arrows { arrows, .. } => {
                        let (x, y, u, v) = arrows[0];
                        prop_assert_eq!([x, y], [state[0], state[1]]);
                        prop_assert!((u - LENGTH * normal[0]).abs() < 1e-12 && (v - LENGTH * normal[1]).abs() < 1e-12);
                    }
                    other => prop_assert!(false, "{other:?}"),
                }
            }
        }
    }
}
