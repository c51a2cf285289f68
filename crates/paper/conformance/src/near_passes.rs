//! Compares the velocities of demonstrations that pass the same place (R9).

use std::collections::BTreeMap;

use anyhow::ensure;
use gp::Rows;
use nalgebra::DVector;

/// Samples slower than this share of the root mean square speed are skipped, because near a goal all directions turn.
const SLOW: f64 = 0.5;

/// Difference between the velocities of two trajectories where they pass near each other (R9).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct NearPasses {
    /// Number of pairs of trajectories that meet.
    pub(super) pairs: usize,
    /// Number of pairs of samples that are near each other.
    pub(super) samples: usize,
    /// 0: same velocities; 1: unrelated; 2: opposite. Every pair of trajectories has the same weight. `None` if no two meet.
    pub(super) share: Option<f64>,
}

impl NearPasses {
    /// Compares samples within `distance` · √(2 Σ_k var x_k) of each other.
    pub(super) fn of(rows: &Rows, distance: f64) -> anyhow::Result<Self> {
        ensure!(distance > 0.0 && distance.is_finite(), "the distance {distance} is not positive and finite");
        if rows.is_empty() {
            return Ok(NearPasses { pairs: 0, samples: 0, share: None });
        }
        Ok(Self::among(rows, &fast(rows), squared_radius(rows, distance)))
    }

    fn among(rows: &Rows, fast: &[usize], squared_radius: f64) -> Self {
        // Count, Σ|u_i − u_j|² and Σ(|u_i|² + |u_j|²) for each pair of trajectories.
        let mut meetings = BTreeMap::<(usize, usize), (usize, f64, f64)>::new();
        let (x, u) = (rows.states(), rows.velocities());
        for (at, &i) in fast.iter().enumerate() {
            for &j in &fast[at + 1..] {
                let (k, l) = (rows.indices()[i].trajectory, rows.indices()[j].trajectory);
                if k == l || (x.column(i) - x.column(j)).norm_squared() > squared_radius {
                    continue;
                }
                let (count, apart, both) = meetings.entry((k.min(l), k.max(l))).or_default();
                *count += 1;
                *apart += (u.column(i) - u.column(j)).norm_squared();
                *both += u.column(i).norm_squared() + u.column(j).norm_squared();
            }
        }
        let sum =
            |part: fn(&(usize, f64, f64)) -> f64| meetings.values().map(|met| part(met) / met.0 as f64).sum::<f64>();
        NearPasses {
            pairs: meetings.len(),
            samples: meetings.values().map(|met| met.0).sum(),
            share: (!meetings.is_empty()).then(|| sum(|met| met.1) / sum(|met| met.2)),
        }
    }
}

/// distance² · 2 Σ_k var x_k, variances over all samples.
fn squared_radius(rows: &Rows, distance: f64) -> f64 {
    let mean: DVector<f64> = rows.states().column_mean();
    let squares: f64 = rows.states().column_iter().map(|x| (x - &mean).norm_squared()).sum();
    distance * distance * 2.0 * squares / rows.len() as f64
}

/// Samples that are not slow.
fn fast(rows: &Rows) -> Vec<usize> {
    let mean_square = rows.velocities().norm_squared() / rows.len() as f64;
    let least = SLOW * SLOW * mean_square;
    (0..rows.len()).filter(|&row| rows.velocities().column(row).norm_squared() >= least).collect()
}

#[cfg(test)]
mod tests {
    use motion::SampleIndex;
    use nalgebra::DMatrix;
    use proptest::prelude::*;

    use super::*;

    fn rows(states: DMatrix<f64>, velocities: DMatrix<f64>, per: usize) -> Rows {
        let index = |row: usize| SampleIndex { trajectory: row / per, sample: row % per };
        let indices = (0..states.ncols()).map(index).collect();
        Rows::new(states, velocities, indices).expect("finite rows")
    }

    /// One copy of the same states for each sign, which determines its direction.
    fn copies(numbers: &[f64], signs: &[f64]) -> Rows {
        let per = numbers.len() / 6;
        let (x, u) = numbers.split_at(3 * per);
        let states: Vec<f64> = signs.iter().flat_map(|_| x.iter().copied()).collect();
        let velocities: Vec<f64> =
            signs.iter().flat_map(|sign| u.iter().map(move |component| (component + 5.0) * sign)).collect();
        let matrix = |numbers| DMatrix::from_vec(3, per * signs.len(), numbers);
        rows(matrix(states), matrix(velocities), per)
    }

    /// Two vectors of three numbers for each of 4 to 11 samples.
    fn samples() -> impl Strategy<Value = Vec<f64>> {
        (4_usize..12).prop_flat_map(|per| prop::collection::vec(-1.0..1.0, 6 * per))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(50))]

        /// A movement differs from its copy by 0, from its reverse by 2.
        #[test]
        fn copies_differ_by_zero_and_reversals_by_two(numbers in samples()) {
            let near = |signs: &[f64]| NearPasses::of(&copies(&numbers, signs), 1e-9).expect("a distance");
            let same = near(&[1.0; 3]);
            prop_assert_eq!((same.pairs, same.samples, same.share), (3, 3 * numbers.len() / 6, Some(0.0)));
            let turned = near(&[1.0, -1.0]);
            prop_assert!((turned.share.expect("they meet") - 2.0).abs() < 1e-12);
            let alone = near(&[1.0]);
            prop_assert_eq!((alone.pairs, alone.share), (0, None));
        }

        /// Counts grow with the distance; units do not matter.
        #[test]
        fn units_do_not_matter(
            (states, velocities) in (prop::collection::vec(-1.5..1.5, 120), prop::collection::vec(-1.0..1.0, 120)),
            (near, more, unit) in (0.02..0.2, 1.0..3.0, 0.01..100.0_f64),
        ) {
            let [states, velocities] = [states, velocities].map(|numbers| DMatrix::from_vec(2, 60, numbers));
            let scaled = rows(&states * unit, &velocities * (3.0 * unit), 12);
            let given = rows(states, velocities, 12);
            let passes = |rows: &Rows, distance: f64| NearPasses::of(rows, distance).expect("a distance");
            let (a, b) = (passes(&given, near), passes(&scaled, near));
            prop_assert_eq!((a.pairs, a.samples), (b.pairs, b.samples));
            prop_assert!((a.share.unwrap_or(0.0) - b.share.unwrap_or(0.0)).abs() < 1e-9);
            prop_assert!(passes(&given, near * more).samples >= a.samples);
        }
    }
}
