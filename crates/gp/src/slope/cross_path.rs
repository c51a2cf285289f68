//! Determines whether left-out movements tested a policy across the paths of the learnt ones.

use motion::upper_median;

use crate::rows::thinning::every_so_many;
use crate::slope::data::SlopeData;

/// Maximum number of rows whose neighbours are examined.
const ROWS: usize = 200;
/// Share of the difference between unrelated directions above which movements pass the same places in other directions.
const OTHERS: f64 = 0.25;
/// Rows of two movements are at the same place if their distance is below this multiple of the usual distance of successive rows of one
/// movement.
const NEAR: f64 = 2.0;

/// Whether movements passed the same places in other directions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum CrossPathEvidence {
    /// Constraints varied: held-out movements test the policy across the paths of the others.
    Tested,
    /// All movements may have gone the same way, so that nothing tested the policy across them.
    Untested,
}

impl CrossPathEvidence {
    /// Decides by directions alone, for a fit without a reading. The nearest row of another movement counts as a neighbour if it is nearer
    /// than twice the median distance of successive rows. The result is `Tested` if the mean of 1 − (nᵀn')² (0 without a neighbour), over
    /// up to 200 rows with weights 1/D, is at least a quarter of 1 − 1/d, the value for unrelated directions. Costs 200 M d.
    pub(crate) fn of_neighbours(data: &SlopeData) -> CrossPathEvidence {
        let (dim, count) = data.n.shape();
        let mut group = vec![0; count];
        for (at, rows) in data.targets.groups.iter().enumerate() {
            for &row in rows {
                group[row] = at;
            }
        }
        let places = data.z.nrows();
        let place = |row: usize| &data.z.as_slice()[row * places..(row + 1) * places];
        let squared = |a: usize, b: usize| place(a).iter().zip(place(b)).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
        let successive =
            data.targets.groups.iter().flat_map(|rows| rows.windows(2).map(|pair| squared(pair[0], pair[1])));
        let usual = upper_median(successive.filter(|&distance| distance > 0.0).collect()).unwrap_or(0.0);
        let turned = |row: usize| {
            let others = (0..count).filter(|&other| group[other] != group[row]);
            let nearest = others.map(|other| (squared(other, row), other)).min_by(|(a, _), (b, _)| a.total_cmp(b));
            let near = nearest.filter(|&(distance, _)| distance <= NEAR.powi(2) * usual);
            let apart = |(_, other): (f64, usize)| 1.0 - data.n.column(row).dot(&data.n.column(other)).powi(2);
            (near.map_or(0.0, apart), 1.0 / data.targets.noise_weights[row])
        };
        let turned = every_so_many(count, ROWS).into_iter().map(turned);
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

    /// Straight movements side by side along an axis; each sample has its own direction of motion.
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

        /// Movements that all go the same way, up to a tenth of noise, test nothing across; movements in random directions do.
        #[test]
        fn random_directions_test_across_the_paths(dim in 2usize..7, seed in any::<u64>()) {
            let rng = &mut ChaCha8Rng::seed_from_u64(seed);
            let mut random = |size: f64| DVector::from_fn(dim, |_, _| rng.random_range(-size..size));
            let alike = beside(dim, || DVector::from_fn(dim, |k, _| if k == 0 { 1.0 } else { 0.0 }) + random(0.1));
            prop_assert_eq!(CrossPathEvidence::of_neighbours(&alike), CrossPathEvidence::Untested);
            let turning = beside(dim, || random(1.0));
            prop_assert_eq!(CrossPathEvidence::of_neighbours(&turning), CrossPathEvidence::Tested);
        }
    }

    /// A few straight movements to one goal do not pass the same places, although their directions differ.
    #[test]
    fn few_rays_leave_the_cross_paths_untested() {
        for (dim, movements) in [(2, 3), (2, 5), (3, 5), (6, 5), (6, 20)] {
            let rng = &mut ChaCha8Rng::seed_from_u64(7);
            let samples = 30;
            let starts: Vec<DVector<f64>> =
                (0..movements).map(|_| DVector::from_fn(dim, |_, _| rng.random_range(-1.0..1.0)).normalize()).collect();
            let state = |row: usize| &starts[row / samples] * (1.0 - 0.9 * (row % samples) as f64 / samples as f64);
            let states: Vec<DVector<f64>> = (0..movements * samples).map(state).collect();
            let x = DMatrix::from_columns(&states);
            let index = |row: usize| motion::SampleIndex { trajectory: row / samples, sample: row % samples };
            let rows = crate::Rows::new(x.clone(), -x, (0..states.len()).map(index).collect()).expect("rows");
            let data = SlopeData::new(&rows, vec![1.0; states.len()]).expect("data");
            assert_eq!(CrossPathEvidence::of_neighbours(&data), CrossPathEvidence::Untested, "{dim} {movements}");
        }
    }

    /// One dimension has no direction across.
    #[test]
    fn one_dimension_leaves_the_cross_paths_untested() {
        let mut sign = 1.0;
        let data = beside(1, || {
            sign = -sign;
            DVector::from_element(1, sign)
        });
        assert_eq!(CrossPathEvidence::of_neighbours(&data), CrossPathEvidence::Untested);
    }
}
