//! The plane of a toy system's states, and what learners make of it.

use motion::Policy;
use nalgebra::{DVector, dvector};
use plot::{Field, Layer, Plane};

use super::{Who, rounded};

/// (x₁, x₂, u₁, u₂).
pub(super) type Arrow = (f64, f64, f64, f64);

/// Both states from −`extent` to `extent`, on a picture of this size, pixels.
pub(super) fn state_plane(title: &str, extent: f64, layers: Vec<Layer>, size: (f64, f64)) -> Plane {
    let range = [-extent, extent];
    Plane {
        title: title.to_owned(),
        x_label: "x₁".to_owned(),
        y_label: "x₂".to_owned(),
        x: range,
        y: range,
        layers,
        size,
    }
}

/// A function of the state from −`extent` to `extent`, with so many steps to either side of 0.
pub(super) fn on_grid(extent: f64, steps: i32, value: impl Fn(&DVector<f64>) -> f64) -> Field {
    let grid: Vec<f64> = (-steps..=steps).map(|i| extent * f64::from(i) / f64::from(steps)).collect();
    let values = grid.iter().map(|&y| grid.iter().map(|&x| value(&dvector![x, y])).collect()).collect();
    Field { x: grid.clone(), y: grid, values }
}

/// The unconstrained actions of a policy on a grid; longer ones than can be meant are cut.
pub(super) fn actions(policy: &dyn Policy, longest: f64) -> Vec<Arrow> {
    let grid = (0..81).map(|i| (f64::from(i % 9 - 4) * 0.45, f64::from(i / 9 - 4) * 0.45));
    let arrow = |(x, y): (f64, f64)| {
        let action = policy.action(dvector![x, y].as_view()).cap_magnitude(longest);
        (rounded(x, 4), rounded(y, 4), rounded(action[0], 5), rounded(action[1], 5))
    };
    grid.map(arrow).collect()
}

/// The true actions, and over them those that somebody learnt, as long as so many seconds of movement.
pub(super) fn compared(truth: &[Arrow], learnt: &[Arrow], who: Who, seconds: f64) -> Vec<Layer> {
    let layer = |arrows: &[Arrow], who: Who, width| Layer::Arrows {
        arrows: arrows.to_vec(),
        color: who.color(),
        scale: seconds,
        width,
        label: None,
    };
    vec![layer(truth, Who::Expert, 3.4), layer(learnt, who, 1.6)]
}
