//! Selects the starts of demonstrations that are shown.

use demo_gen::{GraspStart, UpperBody};

/// Two starts look the same if their palms, taken together, are less than this apart, metres.
const DIFFERENT: f64 = 0.3;

/// Indices in `starts` of those closest to the posture "ready" that differ from each other, at most `number`.
pub(super) fn chosen(body: &UpperBody, starts: &[GraspStart], number: usize) -> Vec<usize> {
    let strangeness = |start: &GraspStart| (&start.posture - body.ready()).norm();
    let mut order: Vec<usize> = (0..starts.len()).collect();
    order.sort_by(|&a, &b| strangeness(&starts[a]).total_cmp(&strangeness(&starts[b])));
    let mut chosen: Vec<usize> = Vec::new();
    for at in order {
        let differs = |other: &usize| (&starts[at].palms - &starts[*other].palms).norm() >= DIFFERENT;
        if chosen.len() < number && chosen.iter().all(differs) {
            chosen.push(at);
        }
    }
    chosen
}
