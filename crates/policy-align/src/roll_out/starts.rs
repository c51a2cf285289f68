use nalgebra::DVector;

use crate::Model;
use crate::halton::between;

/// Candidates for every start; in many dimensions only a few lie in the demonstrated region.
const CANDIDATES: usize = 200;

/// Up to `count` starts for roll-outs: states of the model, (n) each in the units of the recording, spread evenly over the ranges of its
/// channels where the policy is supported, in the fixed or the median context. The starts are deterministic; there are none if the space is
/// too wide to find any.
pub fn spread_starts(model: &Model, count: usize) -> Vec<DVector<f64>> {
    let ranges: Vec<[f64; 2]> = model.state.iter().map(|channel| [channel.low, channel.high]).collect();
    let model = model.in_usual_context();
    let policy = model.policy();
    let places = (1..=count * CANDIDATES).map(|index| between(&ranges, index));
    places.filter(|state| policy.is_supported(state.as_view())).take(count).collect()
}
