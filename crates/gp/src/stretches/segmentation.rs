//! (S21): detects the switches of the constraint within a movement.

use nalgebra::{DMatrix, DVector};

use crate::stretches::partition::{Costs, Growing, Part, SPARE, cheapest_parts, known_part};

/// About half the logarithm of the number of samples: the cost of a parameter, in half squared standard deviations.
pub(crate) const PARAMETER: f64 = 2.5;
/// Cost of one more dimension of the plane. Without it a plane would include a foreign sample at the cost of one dimension,
/// because a plane of q + 1 dimensions contains it exactly.
pub(crate) const DIMENSION: f64 = 10.0;
/// Cost of one more segment.
pub(crate) const SEGMENT: f64 = 6.0;

/// Samples whose velocities lie in a plane; the kind is its rank, below n.
pub(super) type Segment = Part<usize>;

/// Cuts a movement into segments whose velocities, (n, N), lie in planes; some samples may be in none. `noise` is the
/// variance of a velocity along an axis. Dynamic programming over all pairs, in N² n³ time.
pub(super) fn segments(velocities: &DMatrix<f64>, noise: f64) -> Vec<Segment> {
    let (dim, count) = velocities.shape();
    cheapest_parts(count, PARAMETER * dim as f64, PlaneCosts::of(velocities, noise))
}

/// The segment of samples without a switch: all of them, except a few at the ends.
pub(super) fn known_segment(velocities: &DMatrix<f64>, noise: f64) -> Option<Segment> {
    let (dim, count) = velocities.shape();
    known_part(count, PARAMETER * dim as f64, PlaneCosts::of(velocities, noise))
}

/// Costs of planes through samples, and their dimension.
#[derive(Debug, Clone)]
pub(crate) struct PlaneCosts {
    sums: PrefixSums,
    noise: f64,
    /// Residual sums of squares of planes of each rank.
    left: Growing,
}

impl PlaneCosts {
    pub(crate) fn of(velocities: &DMatrix<f64>, noise: f64) -> Self {
        let sums = PrefixSums::of(velocities);
        let left = Growing::new(velocities.ncols(), sums.total());
        PlaneCosts { sums, noise, left }
    }

    /// Cost of a plane of this rank with the residual sum of squares `left`, for `length` samples; `None` if these are too
    /// few.
    fn of_rank(&self, rank: usize, length: usize, left: f64) -> Option<f64> {
        let dim = self.sums.dim;
        let parameters = (rank * length + (rank + 1) * (dim - rank)) as f64;
        let cost = left / self.noise + PARAMETER * parameters + DIMENSION * rank as f64 + SEGMENT;
        (length >= rank + SPARE).then_some(cost)
    }
}

impl Costs for PlaneCosts {
    type Kind = usize;

    fn cost(&mut self, begin: usize, end: usize) -> (f64, usize) {
        let dim = self.sums.dim;
        let eigenvalues = self.sums.scatter(begin, end).symmetric_eigenvalues();
        let mut eigenvalues = eigenvalues.as_slice().to_vec();
        eigenvalues.sort_by(f64::total_cmp);
        let mut best = (f64::INFINITY, 0);
        let mut residual: f64 = eigenvalues.iter().map(|value| value.max(0.0)).sum();
        let mut residuals = Vec::with_capacity(dim);
        for rank in 0..dim {
            residuals.push(residual);
            if let Some(cost) = self.of_rank(rank, end - begin, residual).filter(|cost| *cost < best.0) {
                best = (cost, rank);
            }
            residual -= eigenvalues[dim - 1 - rank].max(0.0);
        }
        self.left.see(begin, &residuals);
        best
    }

    fn at_least(&self, begin: usize, end: usize) -> f64 {
        let at_rank = |rank| self.of_rank(rank, end - begin, self.left.at_least(begin, rank));
        (0..self.sums.dim).filter_map(at_rank).fold(f64::INFINITY, f64::min)
    }
}

/// Cumulative sums of u and u uᵀ, of velocities relative to their mean.
#[derive(Debug, Clone)]
pub(crate) struct PrefixSums {
    dim: usize,
    /// `None` for scatters about 0.
    first: Option<Vec<DVector<f64>>>,
    second: Vec<DMatrix<f64>>,
}

impl PrefixSums {
    pub(crate) fn of(velocities: &DMatrix<f64>) -> Self {
        PrefixSums::about(velocities, &velocities.column_mean())
    }

    /// Sums for scatters about 0 instead of the mean.
    pub(crate) fn about_zero(velocities: &DMatrix<f64>) -> Self {
        PrefixSums { first: None, ..PrefixSums::about(velocities, &DVector::zeros(velocities.nrows())) }
    }

    fn about(velocities: &DMatrix<f64>, origin: &DVector<f64>) -> Self {
        let dim = velocities.nrows();
        let (mut first, mut second) = (vec![DVector::zeros(dim)], vec![DMatrix::zeros(dim, dim)]);
        for (at, velocity) in velocities.column_iter().enumerate() {
            let centred = velocity - origin;
            second.push(&second[at] + &centred * centred.transpose());
            first.push(&first[at] + centred);
        }
        PrefixSums { dim, first: Some(first), second }
    }

    pub(crate) fn is_about_zero(&self) -> bool {
        self.first.is_none()
    }

    /// Σ |u − mean u|² of all samples, or Σ |u|².
    pub(crate) fn total(&self) -> f64 {
        self.second.last().map_or(0.0, DMatrix::trace)
    }

    /// Σ (u − ū)(u − ū)ᵀ over `begin..end`, or Σ uuᵀ.
    pub(crate) fn scatter(&self, begin: usize, end: usize) -> DMatrix<f64> {
        let mut scatter = &self.second[end] - &self.second[begin];
        if let Some(first) = &self.first {
            let sum = &first[end] - &first[begin];
            scatter.ger(-1.0 / (end - begin) as f64, &sum, &sum, 1.0);
        }
        scatter
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;

    /// Random velocities with a constant component along a normal; from `switch` on, with another normal and another
    /// constant.
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
        /// A switch between two planes is found to the sample, and so are the dimensions of both.
        #[test]
        fn switches_are_found(dim in 2usize..5, before in 25usize..40, after in 25usize..40, seed in any::<u64>()) {
            let velocities = pushed(dim, before + after, before, seed);
            let found = segments(&velocities, 1e-10);
            let rank = dim - 1;
            let expected =
                [Segment { begin: 0, end: before, kind: rank }, Segment { begin: before, end: before + after, kind: rank }];
            prop_assert_eq!(found, expected);
        }

        /// The scatter of any part from cumulative sums equals its definition.
        #[test]
        fn scatters_are_as_defined(dim in 1usize..5, begin in 0usize..10, length in 2usize..10, seed in any::<u64>()) {
            let velocities = pushed(dim, 20, 10, seed);
            let part = velocities.columns(begin, length).into_owned();
            let mean = part.column_mean();
            let centred = DMatrix::from_fn(dim, length, |axis, at| part[(axis, at)] - mean[axis]);
            let scatter = PrefixSums::of(&velocities).scatter(begin, begin + length);
            prop_assert!((scatter - &centred * centred.transpose()).amax() < 1e-12);
            let about_zero = PrefixSums::about_zero(&velocities).scatter(begin, begin + length);
            prop_assert!((about_zero - &part * part.transpose()).amax() < 1e-12);
        }

        /// Velocities in all directions have no segment, whatever lower noise is assumed.
        #[test]
        fn free_movements_have_no_segments(dim in 2usize..5, count in 20usize..50, seed in any::<u64>()) {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let velocities = DMatrix::from_fn(dim, count, |_, _| 2.0 * rng.random::<f64>() - 1.0);
            prop_assert_eq!(segments(&velocities, 1e-8), []);
        }
    }
}
