use nalgebra::DVector;

use super::gp_tables::Scaled;
use crate::Model;

/// States at which the model is asked whether it knows them.
const ASKED: usize = 400;

/// How far from a learnt state a state still counts as known in an exported Gaussian process, squared, in its scaled
/// coordinates.
///
/// The variance that decides in the model itself needs a matrix of the size of all samples squared. What is exported asks
/// for the nearest learnt state instead. The reach is such that of states asked in the box of the data, widened by half
/// on every side, none that the model does not know lies within it.
pub(super) fn squared_reach(model: &Model, scaled: &Scaled) -> f64 {
    let policy = model.policy();
    let (mut nearest_unknown, mut farthest) = (f64::INFINITY, 0.0_f64);
    for index in 1..=ASKED {
        let state = DVector::from_fn(model.state.len(), |k, _| {
            let channel = &model.state[k];
            let width = channel.high - channel.low;
            channel.low - 0.5 * width + 2.0 * width * radical_inverse(index, k)
        });
        let z = DVector::from_fn(state.len(), |k, _| {
            (state[k] * model.state[k].scale - scaled.mean[k]) / scaled.spread
        });
        let squared = scaled.z.column_iter().map(|row| (row - &z).norm_squared()).fold(f64::INFINITY, f64::min);
        farthest = farthest.max(squared);
        if !policy.is_supported(state.as_view()) {
            nearest_unknown = nearest_unknown.min(squared);
        }
    }
    // Half a per cent nearer, so that rounding decides nothing.
    (0.995 * nearest_unknown).min(farthest)
}

/// Halton's sequence: number `index` of an even covering of (0, 1), in dimension `axis`.
fn radical_inverse(index: usize, axis: usize) -> f64 {
    let base = (2..).filter(|n| (2..*n).take_while(|d| d * d <= *n).all(|d| n % d != 0)).nth(axis).unwrap_or(2);
    let (mut left, mut share, mut value) = (index, 1.0 / base as f64, 0.0);
    while left > 0 {
        value += share * (left % base) as f64;
        left /= base;
        share /= base as f64;
    }
    value
}
