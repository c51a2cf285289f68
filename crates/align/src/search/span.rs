use motion::Demonstrations;

use crate::AlignError;

/// Checks that squared distances are finite, which holds if the diagonal of the data's bounding box is.
///
/// # Errors
/// [`AlignError::SpanOverflow`] if it is not.
pub(crate) fn check_span(demonstrations: &Demonstrations) -> Result<(), AlignError> {
    let span = |dimension: usize| {
        let states = demonstrations.trajectories().iter().flat_map(|t| t.states().column_iter());
        let extend = |(low, high): (f64, f64), x: f64| (low.min(x), high.max(x));
        let (low, high) = states.map(|state| state[dimension]).fold((f64::INFINITY, f64::NEG_INFINITY), extend);
        high - low
    };
    let spans: Vec<f64> = (0..demonstrations.dim()).map(span).collect();
    if spans.iter().map(|span| span * span).sum::<f64>().is_finite() {
        return Ok(());
    }
    let widest = (0..spans.len()).max_by(|&a, &b| spans[a].total_cmp(&spans[b])).expect("a state has a dimension");
    Err(AlignError::SpanOverflow { dimension: widest, span: spans[widest] })
}
