//! Which of the demonstrations' starts are shown.

use demo_gen::{GraspStart, UpperBody};

/// Starts whose palms, taken together, are less than this apart look the same, metres.
const DIFFERENT: f64 = 0.3;

/// The starts most like the posture "ready", but not like each other: places in `starts`, at most so many.
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
