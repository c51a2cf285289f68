//! Whether left-out movements tested a policy across the paths of those learnt from.

use crate::rows::thinning::every_so_many;
use crate::slope::data::SlopeData;

/// Rows whose neighbours are looked at, at most.
const ROWS: usize = 200;
/// Share of what unrelated directions differ by, from which movements pass the same places in others.
const OTHERS: f64 = 0.25;

/// Whether movements passed the same places in other directions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum CrossPathEvidence {
    /// Constraints varied: held-out movements test the policy across the paths of the others.
    Tested,
    /// All movements may have gone alike, so that nothing tested the policy across them.
    Untested,
}

impl CrossPathEvidence {
    /// By directions alone, where there is no reading: those of the nearest rows of other movements. Over up to 200 rows, of weights 1/D, the
    /// mean of 1 − (nᵀn')² is at least a quarter of 1 − 1/d, which unrelated directions have.
    pub(crate) fn of_neighbours(data: &SlopeData) -> CrossPathEvidence {
        let (dim, count) = data.n.shape();
        let mut group = vec![0; count];
        for (at, rows) in data.groups.iter().enumerate() {
            for &row in rows {
                group[row] = at;
            }
        }
        let turned = |row: usize| {
            let z = data.z.column(row);
            let others = (0..count).filter(|&other| group[other] != group[row]);
            let distances = others.map(|other| ((data.z.column(other) - z).norm_squared(), other));
            let nearest = distances.min_by(|(a, _), (b, _)| a.total_cmp(b))?.1;
            Some((1.0 - data.n.column(row).dot(&data.n.column(nearest)).powi(2), 1.0 / data.noise_weights[row]))
        };
        let turned = every_so_many(count, ROWS).into_iter().filter_map(turned);
        let (sum, weights) =
            turned.fold((0.0, 0.0), |(sum, weights), (turned, weight)| (sum + weight * turned, weights + weight));
        let unrelated = 1.0 - 1.0 / dim as f64;
        if dim > 1 && sum >= OTHERS * unrelated * weights { Self::Tested } else { Self::Untested }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};
    use proptest::prelude::*;
    use rand::SeedableRng as _;
    use rand_chacha::ChaCha8Rng;

    use super::*;

    /// Straight movements side by side along an axis, of which each sample moves along its own direction.
    fn beside(dim: usize, mut direction: impl FnMut() -> DVector<f64>) -> SlopeData {
        let (movements, samples) = (12, 10);
        let state = |row: usize| {
            let (movement, sample) = ((row / samples) as f64, (row % samples) as f64);
            DVector::from_fn(dim, |k, _| if k == 0 { 0.1 * sample } else { 0.05 * movement })
        };
        let count = movements * samples;
        let states: Vec<DVector<f64>> = (0..count).map(state).collect();
        let velocities: Vec<DVector<f64>> = (0..count).map(|_| direction()).collect();
        let index = |row: usize| motion::SampleIndex { trajectory: row / samples, sample: row % samples };
        let (x, u) = (DMatrix::from_columns(&states), DMatrix::from_columns(&velocities));
        let rows = crate::Rows::new(x, u, (0..count).map(index).collect()).expect("rows");
        SlopeData::new(&rows, vec![1.0; count]).expect("data")
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]

        /// Movements that all go alike, but for a tenth of noise, test nothing across; movements in random directions do.
        #[test]
        fn movements_in_other_directions_test_across(dim in 2usize..7, seed in any::<u64>()) {
            let rng = &mut ChaCha8Rng::seed_from_u64(seed);
            let mut random = |size: f64| DVector::from_fn(dim, |_, _| rng.random_range(-size..size));
            let alike = beside(dim, || DVector::from_fn(dim, |k, _| if k == 0 { 1.0 } else { 0.0 }) + random(0.1));
            prop_assert_eq!(CrossPathEvidence::of_neighbours(&alike), CrossPathEvidence::Untested);
            let turning = beside(dim, || random(1.0));
            prop_assert_eq!(CrossPathEvidence::of_neighbours(&turning), CrossPathEvidence::Tested);
        }
    }

    /// In one dimension nothing lies across.
    #[test]
    fn one_dimension_has_no_across() {
        let mut sign = 1.0;
        let data = beside(1, || {
            sign = -sign;
            DVector::from_element(1, sign)
        });
        assert_eq!(CrossPathEvidence::of_neighbours(&data), CrossPathEvidence::Untested);
    }
}
