//! Surfaces that no movement crosses, and points that all lead through, found without a policy. A constraint common to all movements may hide the policy across them.

mod common_plane;
mod common_point;
mod common_surface;
mod quadratics;
mod wall;

pub(crate) use common_plane::CommonPlane;
pub(crate) use common_point::common_point;
pub(crate) use common_surface::common_surface;
pub(crate) use wall::wall;

use nalgebra::{DMatrix, DVector};
use prepare::numbers::short;
use prepare::sum_of_parts;

use crate::StateChannel;

/// At most `most` of `count` indices, evenly spread over all.
fn some_of(count: usize, most: usize) -> Vec<usize> {
    (0..count).step_by(count.div_ceil(most).max(1)).collect()
}

/// Adds the scatter of states (n, N) about their mean to the lower triangle of `scatter`, (n, n); returns the mean.
fn add_scatter(scatter: &mut DMatrix<f64>, states: &DMatrix<f64>) -> DVector<f64> {
    let mean = states.column_mean();
    states.column_iter().for_each(|x| scatter.syger(1.0, &(x - &mean), &(x - &mean), 1.0));
    mean
}

/// Converts the normal of nᵀSx, where Sx is the learner's state, to the unit normal of nᵀx in the units of the recording, with a
/// positive largest entry. Also returns the divisor of nᵀSx.
fn as_recorded(normal: &DVector<f64>, state: &[StateChannel]) -> (DVector<f64>, f64) {
    let normal = DVector::from_fn(state.len(), |k, _| normal[k] * state[k].scale);
    let length = normal.norm() * if normal[normal.iamax()] < 0.0 { -1.0 } else { 1.0 };
    (normal / length, length)
}

/// A unit normal as text: 0.36 x + 0.86 y.
fn parts(normal: &DVector<f64>, state: &[StateChannel]) -> String {
    let names: Vec<&str> = state.iter().map(|channel| channel.name.as_str()).collect();
    sum_of_parts(normal.as_slice(), &names, 3)
}

/// A plane as text, in the units of the recording: 0.36 x + 0.86 y = 1.2 m.
fn equation(normal: &DVector<f64>, level: f64, state: &[StateChannel]) -> String {
    let unit = match state.first().and_then(|channel| channel.unit.as_deref()) {
        Some(unit) if state.iter().all(|channel| channel.unit.as_deref() == Some(unit)) => format!(" {unit}"),
        _ => String::new(),
    };
    format!("{} = {}{unit}", parts(normal, state), short(level))
}

/// Channels for tests, in metres.
#[cfg(test)]
fn channels() -> Vec<StateChannel> {
    let channel = |name: &str| StateChannel {
        name: name.to_owned(),
        unit: Some("m".to_owned()),
        scale: 1.0,
        low: -1.0,
        high: 1.0,
        median: 0.0,
    };
    ["x", "y", "z"].map(channel).to_vec()
}
