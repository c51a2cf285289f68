use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

/// Minimum difference of b from 0, in standard deviations and as a share of the speed.
const DEVIATIONS: f64 = 3.0;
const SHARE: f64 = 0.01;

/// The constraint (or its absence) on a stretch of a movement.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Acting {
    /// A constraint A u = b, constant in its space.
    Constraint,
    /// An influence that deflects the movement, but without constant A and b: a curved surface, or too many switches.
    Changing,
    /// No visible constraint: the movement follows the policy.
    Nothing,
    /// The policy does not move either, so that no constraint would be visible.
    Unseen,
}

/// A stretch of a movement, and the constraint that acted on it.
#[derive(Debug, Clone, PartialEq)]
pub struct StretchEstimate {
    /// Index of the movement.
    pub trajectory: usize,
    /// First and last sample.
    pub samples: (usize, usize),
    /// The kind of constraint.
    pub acting: Acting,
    /// Index of the task space to whose velocities v the constraint A v = b applies.
    pub space: usize,
    /// A, (k, m): orthonormal rows, the largest entry of each positive. No rows unless there is a constraint.
    pub matrix: DMatrix<f64>,
    /// b, (k): mean velocity along each row, in units of the space per second; 0 if no constraint of the recording moves.
    pub bound: DVector<f64>,
    /// Standard deviation of each component of b.
    pub bound_deviation: f64,
    /// Root mean square speed in the space.
    pub speed: f64,
    /// Expected angle between a row and the true rows' span, in radians.
    pub angle: f64,
    /// Logarithm of the likelihood ratio of this constraint to none.
    pub evidence: f64,
    /// Directions of the recorded coordinates, (n, r), along which a further constraint would not be visible, because the
    /// velocity does not vary along them, and the policy has no component there.
    pub hidden: DMatrix<f64>,
}

impl StretchEstimate {
    /// Whether b of a row differs from 0, that is, the constraint pushes.
    pub fn pushes(&self, row: usize) -> bool {
        self.bound[row].abs() > (DEVIATIONS * self.bound_deviation).max(SHARE * self.speed)
    }
}

/// Orthonormal rows (k, m) with the same span, along axes as far as possible, the largest entry of each positive.
pub(super) fn canonical(columns: &DMatrix<f64>) -> DMatrix<f64> {
    let (dim, rank) = columns.shape();
    let mut span = columns * columns.transpose();
    let mut rows = DMatrix::zeros(rank, dim);
    for at in 0..rank {
        let diagonal = span.diagonal();
        let row = span.column(diagonal.imax()).normalize();
        let row = if row[row.iamax()] < 0.0 { -row } else { row };
        span -= &row * row.transpose();
        rows.set_row(at, &row.transpose());
    }
    rows
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;

    proptest! {
        /// The rows are orthonormal, span the same space, and have positive largest entries.
        #[test]
        fn canonical_rows_are_orthonormal_and_span_the_same(dim in 1usize..7, seed in any::<u64>()) {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let rank = rng.random_range(1..=dim);
            let drawn = DMatrix::from_fn(dim, rank, |_, _| 2.0 * rng.random::<f64>() - 1.0).qr().q();
            let rows = canonical(&drawn);
            prop_assert!((&rows * rows.transpose() - DMatrix::identity(rank, rank)).amax() < 1e-8);
            prop_assert!((rows.tr_mul(&rows) - &drawn * drawn.transpose()).amax() < 1e-8);
            prop_assert!(rows.row_iter().all(|row| row.amax() == row.max()));
        }
    }

    /// Axes are found whatever the basis of their span.
    #[test]
    fn axes_are_found_in_any_basis() {
        let turned = DMatrix::from_row_slice(3, 2, &[0.6, -0.8, 0.0, 0.0, -0.8, -0.6]);
        let rows = canonical(&turned);
        let axes = DMatrix::from_row_slice(2, 3, &[1.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
        assert!((rows - axes).amax() < 1e-12);
    }
}
