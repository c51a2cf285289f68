use gp::ScaledStates;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::Model;
use crate::halton::between;

/// Number of states at which the model's support is evaluated.
const STATES: usize = 1000;
/// Largest share of the states within the radius that the model itself does not support.
const UNKNOWN: f64 = 0.05;

/// Squared distance from a learnt state up to which an exported Gaussian process supports a state, in its scaled coordinates;
/// negative if it supports none.
///
/// The model itself decides by the variance, which needs a matrix of the squared number of samples. The export uses the distance to
/// the nearest learnt state instead. The radius is the largest one within which the model supports 95 % of the states, spread
/// evenly over the model's bounds.
pub(super) fn squared_radius(model: &Model, scaled: &ScaledStates<'_>) -> f64 {
    let model = Model { chosen_context: crate::model::no_context(), ..model.clone() };
    let scale = model.input_scales();
    let (policy, bounds) = (model.policy(), model.bounds());
    let states: Vec<DVector<f64>> = (1..=STATES).map(|index| between(&bounds, index)).collect();
    let supported = policy.are_supported(DMatrix::from_columns(&states).as_view());
    let evaluated = states.par_iter().zip(supported).map(|(state, known)| {
        let z = DVector::from_fn(state.len(), |k, _| (state[k] * scale[k] - scaled.mean[k]) / scaled.spread);
        let nearest = scaled.z.column_iter().map(|row| (row - &z).norm_squared()).fold(f64::INFINITY, f64::min);
        (nearest, known)
    });
    let mut evaluated: Vec<_> = evaluated.collect();
    evaluated.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut unknown, mut squared_radius) = (0, -1.0);
    for (count, (squared, known)) in evaluated.into_iter().enumerate() {
        unknown += usize::from(!known);
        if known && unknown as f64 <= UNKNOWN * (count + 1) as f64 {
            squared_radius = squared;
        }
    }
    squared_radius
}
