use nalgebra::DVector;

use crate::Model;
use crate::halton::between;

/// Candidates for every start; in many dimensions few lie in the demonstrated region.
const CANDIDATES: usize = 200;

/// Up to `count` starts for roll-outs: states of the model, (n) each in the units of the recording, spread evenly over
/// the ranges of its channels where it knows something, in the context that was chosen or else the usual one. Always the same ones; none in a space too wide to find any.
pub fn spread_starts(model: &Model, count: usize) -> Vec<DVector<f64>> {
    let ranges: Vec<[f64; 2]> = model.state.iter().map(|channel| [channel.low, channel.high]).collect();
    let model = model.in_usual_context();
    let policy = model.policy();
    let places = (1..=count * CANDIDATES).map(|index| between(&ranges, index));
    places.filter(|state| policy.is_supported(state.as_view())).take(count).collect()
}
