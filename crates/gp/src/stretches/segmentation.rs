//! (S21): where in a movement the constraint switched.

use nalgebra::{DMatrix, DVector};

/// Half the logarithm of the number of samples, about: what a parameter costs in half squared standard deviations.
pub(crate) const PARAMETER: f64 = 2.5;
/// What one more dimension of the plane costs. Without it a plane takes in a foreign sample by one dimension more, since a
/// plane of q + 1 dimensions goes through it exactly.
pub(crate) const DIMENSION: f64 = 10.0;
/// What one more segment costs.
pub(crate) const SEGMENT: f64 = 6.0;
/// Samples beyond the dimension of the plane that a segment needs.
pub(crate) const SPARE: usize = 4;

/// Samples whose velocities lie in a plane; the kind is its rank, 0 < rank < n.
pub(super) type Segment = Part<usize>;

/// Cuts a movement into segments whose velocities, (n, N), lie in planes, or in none. `noise` is the variance of a velocity
/// along an axis. A dynamic programme over all pairs: time with N² n³.
pub(super) fn segments(velocities: &DMatrix<f64>, noise: f64) -> Vec<Segment> {
    let (dim, count) = velocities.shape();
    let sums = PrefixSums::of(velocities);
    let mut parts = cheapest_parts(count, PARAMETER * dim as f64, |begin, end| plane_cost(&sums, (begin, end), noise));
    parts.retain(|part| part.kind > 0);
    parts
}

/// The same where no constraint switched among these samples: all of them, but for a few at the ends.
pub(super) fn known_segment(velocities: &DMatrix<f64>, noise: f64) -> Option<Segment> {
    let (dim, count) = velocities.shape();
    let sums = PrefixSums::of(velocities);
    let part = known_part(count, PARAMETER * dim as f64, |begin, end| plane_cost(&sums, (begin, end), noise));
    part.filter(|part| part.kind > 0)
}

/// Samples `begin..end` of a movement, and what they are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Part<K> {
    pub(crate) begin: usize,
    pub(crate) end: usize,
    pub(crate) kind: K,
}

/// The parts of `count` samples whose costs, with `alone` for each sample in none, have the least sum. `cost` of a part
/// begin..end of at least [`SPARE`] samples also says of which kind it is. Asks for all pairs.
pub(crate) fn cheapest_parts<K: Copy>(
    count: usize,
    alone: f64,
    cost: impl Fn(usize, usize) -> (f64, K),
) -> Vec<Part<K>> {
    // The least cost of the samples before each, and the part that ends there, if any.
    let mut costs = vec![0.0; count + 1];
    let mut ending: Vec<Option<Part<K>>> = vec![None; count + 1];
    for end in 1..=count {
        costs[end] = costs[end - 1] + alone;
        for begin in 0..(end + 1).saturating_sub(SPARE) {
            let (own, kind) = cost(begin, end);
            if costs[begin] + own < costs[end] {
                costs[end] = costs[begin] + own;
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

/// Of samples that a label says belong together, at most so many at either end may belong to what was before or comes after: labels
/// are late, and smoothing reaches across a switch.
const STRAY: usize = 2;

/// The part of `count` samples among which nothing switched, as [`cheapest_parts`] would cost it; none if samples in no part cost less.
pub(crate) fn known_part<K: Copy>(
    count: usize,
    alone: f64,
    cost: impl Fn(usize, usize) -> (f64, K),
) -> Option<Part<K>> {
    let mut best = (alone * count as f64, None);
    for end in (count.saturating_sub(STRAY)..=count).rev() {
        for begin in 0..=STRAY.min(end.saturating_sub(SPARE)) {
            if end < begin + SPARE {
                continue;
            }
            let (own, kind) = cost(begin, end);
            let all = own + alone * (count - (end - begin)) as f64;
            if all < best.0 {
                best = (all, Some(Part { begin, end, kind }));
            }
        }
    }
    best.1
}

/// The least cost of planes through these samples, and their dimension.
fn plane_cost(sums: &PrefixSums, (begin, end): (usize, usize), noise: f64) -> (f64, usize) {
    let length = end - begin;
    let dim = sums.dim;
    let eigenvalues = sums.scatter(begin, end).symmetric_eigenvalues();
    let mut eigenvalues = eigenvalues.as_slice().to_vec();
    eigenvalues.sort_by(f64::total_cmp);
    let mut best = (f64::INFINITY, 0);
    let mut residual: f64 = eigenvalues.iter().map(|value| value.max(0.0)).sum();
    for rank in 0..dim {
        if length < rank + SPARE {
            break;
        }
        let parameters = (rank * length + (rank + 1) * (dim - rank)) as f64;
        let cost = residual / noise + PARAMETER * parameters + DIMENSION * rank as f64 + SEGMENT;
        if cost < best.0 {
            best = (cost, rank);
        }
        residual -= eigenvalues[dim - 1 - rank].max(0.0);
    }
    best
}

/// Sums of u and u uᵀ over the first samples, of velocities about their mean.
pub(crate) struct PrefixSums {
    dim: usize,
    first: Vec<DVector<f64>>,
    second: Vec<DMatrix<f64>>,
}

impl PrefixSums {
    pub(crate) fn of(velocities: &DMatrix<f64>) -> Self {
        let dim = velocities.nrows();
        let mean = velocities.column_mean();
        let (mut first, mut second) = (vec![DVector::zeros(dim)], vec![DMatrix::zeros(dim, dim)]);
        for (at, velocity) in velocities.column_iter().enumerate() {
            let centred = velocity - &mean;
            second.push(&second[at] + &centred * centred.transpose());
            first.push(&first[at] + centred);
        }
        PrefixSums { dim, first, second }
    }

    /// Σ (u − ū)(u − ū)ᵀ over `begin..end`.
    pub(crate) fn scatter(&self, begin: usize, end: usize) -> DMatrix<f64> {
        let sum = &self.first[end] - &self.first[begin];
        let mut scatter = &self.second[end] - &self.second[begin];
        scatter.ger(-1.0 / (end - begin) as f64, &sum, &sum, 1.0);
        scatter
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;

    /// Random velocities whose part along a normal is constant, with another normal and another constant from `switch` on.
    fn pushed(dim: usize, count: usize, switch: usize, seed: u64) -> DMatrix<f64> {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut draw = |rows, columns| DMatrix::from_fn(rows, columns, |_, _| 2.0 * rng.random::<f64>() - 1.0);
        let mut velocities = draw(dim, count);
        for part in [0..switch, switch..count] {
            let (normal, push) = (draw(dim, 1).normalize(), draw(1, 1)[0]);
            for at in part {
                let along = velocities.column(at).dot(&normal.column(0));
                velocities.column_mut(at).axpy(push - along, &normal.column(0), 1.0);
            }
        }
        velocities
    }

    proptest! {
        /// A switch between two planes is found to the sample, and so is the dimension of both.
        #[test]
        fn switches_are_found(dim in 2usize..5, before in 25usize..40, after in 25usize..40, seed in any::<u64>()) {
            let velocities = pushed(dim, before + after, before, seed);
            let found = segments(&velocities, 1e-10);
            let rank = dim - 1;
            let expected =
                [Segment { begin: 0, end: before, kind: rank }, Segment { begin: before, end: before + after, kind: rank }];
            prop_assert_eq!(found, expected);
        }

        /// Sums over the beginning give the scatter of any part as its definition does.
        #[test]
        fn scatters_are_as_defined(dim in 1usize..5, begin in 0usize..10, length in 2usize..10, seed in any::<u64>()) {
            let velocities = pushed(dim, 20, 10, seed);
            let part = velocities.columns(begin, length).into_owned();
            let mean = part.column_mean();
            let centred = DMatrix::from_fn(dim, length, |axis, at| part[(axis, at)] - mean[axis]);
            let scatter = PrefixSums::of(&velocities).scatter(begin, begin + length);
            prop_assert!((scatter - &centred * centred.transpose()).amax() < 1e-12);
        }

        /// Velocities in all directions have no segment, whatever the noise is thought to be below them.
        #[test]
        fn free_movement_has_none(dim in 2usize..5, count in 20usize..50, seed in any::<u64>()) {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let velocities = DMatrix::from_fn(dim, count, |_, _| 2.0 * rng.random::<f64>() - 1.0);
            prop_assert_eq!(segments(&velocities, 1e-8), []);
        }
    }
}
