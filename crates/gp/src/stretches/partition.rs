//! Divides a movement into the parts with the least total cost.

/// Minimum number of samples of a part beyond the dimension of its model.
pub(crate) const SPARE: usize = 4;

/// Samples `begin..end` of a movement, and their kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Part<K> {
    pub(crate) begin: usize,
    pub(crate) end: usize,
    pub(crate) kind: K,
}

/// Costs of parts.
pub(crate) trait Costs {
    /// The kind of a part.
    type Kind: Copy;

    /// The least cost of samples begin..end, at least [`SPARE`] of them, and the kind that has it.
    fn cost(&mut self, begin: usize, end: usize) -> (f64, Self::Kind);

    /// A lower bound on this cost that is fast to compute.
    fn at_least(&self, begin: usize, end: usize) -> f64;
}

/// The parts of `count` samples with the least total cost, where `alone` is the cost of each sample in no part. Among equal sums, takes
/// the one whose last part is longest. Considers all pairs, and computes the cost of those that their bounds do not exclude.
pub(crate) fn cheapest_parts<C: Costs>(count: usize, alone: f64, mut costs: C) -> Vec<Part<C::Kind>> {
    // The least cost of the samples before each, and the part that ends there, if any.
    let mut least = vec![0.0; count + 1];
    let mut ending: Vec<Option<Part<C::Kind>>> = vec![None; count + 1];
    for end in 1..=count {
        least[end] = least[end - 1] + alone;
        // Usually a part continues, so candidates that cost more than its continuation are skipped.
        let on = ending[end - 1].filter(|part| part.begin + SPARE <= end);
        let on = on.map(|part| (part.begin, costs.cost(part.begin, end)));
        let most = on.as_ref().map_or(least[end], |(begin, (own, _))| least[end].min(least[*begin] + own));
        for begin in 0..(end + 1).saturating_sub(SPARE) {
            let (own, kind) = match &on {
                Some((at, found)) if *at == begin => *found,
                _ if least[begin] + costs.at_least(begin, end) > most => continue,
                _ => costs.cost(begin, end),
            };
            if least[begin] + own < least[end] {
                least[end] = least[begin] + own;
                ending[end] = Some(Part { begin, end, kind });
            }
        }
    }
    let mut found = Vec::new();
    let mut at = count;
    while at > 0 {
        at = ending[at].map_or(at - 1, |part| {
            found.push(part);
            part.begin
        });
    }
    found.reverse();
    found
}

/// Sums of squares that cannot decrease as a part grows; for each begin, those of the last part that was evaluated.
#[derive(Debug, Clone)]
pub(crate) struct Growing {
    seen: Vec<Vec<f64>>,
    /// Amount by which rounding may lower a sum.
    rounding: f64,
}

impl Growing {
    /// For `count` samples; `total` is at least as large as the sums whose differences are the parts' sums.
    pub(crate) fn new(count: usize, total: f64) -> Self {
        Growing { seen: vec![Vec::new(); count], rounding: ROUNDINGS * f64::EPSILON * total }
    }

    pub(crate) fn see(&mut self, begin: usize, sums: &[f64]) {
        self.seen[begin].clear();
        self.seen[begin].extend_from_slice(sums);
    }

    /// A lower bound on one of the sums of all longer parts.
    pub(crate) fn at_least(&self, begin: usize, which: usize) -> f64 {
        self.seen[begin].get(which).map_or(0.0, |sum| (sum - self.rounding).max(0.0))
    }
}

/// Maximum accumulated rounding error of a sum of squares, in units of the machine epsilon.
const ROUNDINGS: f64 = 64.0;

/// Maximum number of samples at either end of a labelled part that may belong to the previous or next part, because labels are late, and
/// smoothing reaches across a switch.
const STRAY: usize = 2;

/// The part of `count` samples without a switch, with the costs of [`cheapest_parts`]; `None` if samples in no part cost less.
pub(crate) fn known_part<C: Costs>(count: usize, alone: f64, mut costs: C) -> Option<Part<C::Kind>> {
    let mut best = (alone * count as f64, None);
    for end in (count.saturating_sub(STRAY)..=count).rev() {
        for begin in 0..=STRAY.min(end.saturating_sub(SPARE)) {
            if end < begin + SPARE {
                continue;
            }
            let (own, kind) = costs.cost(begin, end);
            let all = own + alone * (count - (end - begin)) as f64;
            if all < best.0 {
                best = (all, Some(Part { begin, end, kind }));
            }
        }
    }
    best.1
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;
    use proptest::prelude::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;
    use crate::stretches::segmentation::{PARAMETER, PlaneCosts};

    /// The same costs without bounds.
    struct Unbounded(PlaneCosts);

    impl Costs for Unbounded {
        type Kind = usize;

        fn cost(&mut self, begin: usize, end: usize) -> (f64, usize) {
            self.0.cost(begin, end)
        }

        fn at_least(&self, _begin: usize, _end: usize) -> f64 {
            f64::NEG_INFINITY
        }
    }

    proptest! {
        /// Bounds only exclude parts that are not the best: the result equals that of all pairs, for planes with pushes and switches,
        /// with much noise or at the limit of rounding, and for velocities without a plane.
        #[test]
        fn bounds_change_nothing(
            dim in 2usize..5,
            lengths in prop::collection::vec(1usize..30, 1..5),
            noise in prop::sample::select(vec![0.0, 1e-6, 1e-3, 0.1, 1.0]),
            seed in any::<u64>(),
        ) {
            let rng = &mut ChaCha8Rng::seed_from_u64(seed);
            let mut draw = |rows, columns| DMatrix::from_fn(rows, columns, |_, _| 2.0 * rng.random::<f64>() - 1.0);
            let mut columns = Vec::new();
            for length in lengths {
                let (normal, push) = (draw(dim, 1).normalize(), draw(1, 1)[0]);
                for _ in 0..length {
                    let velocity = draw(dim, 1);
                    let along = velocity.dot(&normal);
                    columns.push((velocity + &normal * (push - along) + draw(dim, 1) * noise).column(0).into_owned());
                }
            }
            let velocities = DMatrix::from_columns(&columns);
            let variance = (noise * noise / 3.0).max(1e-14);
            let (count, alone) = (columns.len(), PARAMETER * dim as f64);
            let costs = PlaneCosts::of(&velocities, variance);
            let bounded = cheapest_parts(count, alone, costs.clone());
            prop_assert_eq!(bounded, cheapest_parts(count, alone, Unbounded(costs)));
        }
    }
}
