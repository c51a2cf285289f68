//! Constraints on several recorded channels at once, as of locked joints.

use nalgebra::{DMatrix, DVector};

/// A channel is held if its mean square velocity is at most this multiple of the noise.
const HELD: f64 = 2.0;
/// A row of A concerns a channel if the square of the channel's entry exceeds this.
const CONCERNS: f64 = 0.02;
/// Maximum sum of a row's squared entries on other channels than those that are held.
const OTHERS: f64 = 0.05;

/// One row for each held channel that the rows of `matrix` (r, n) concern, (k, n), and the standard deviation of the angle between a row and
/// the true rows' span, from how much the other channels move; `None` unless these are more than r and contain the rows.
///
/// If several channels are held, the policy may keep nearly one direction among them, and a single row of A along it explains what is
/// missing. That all of these channels are still would then be a coincidence.
pub(super) fn held_channels(
    matrix: &DMatrix<f64>,
    velocities: &DMatrix<f64>,
    noise: f64,
) -> Option<(DMatrix<f64>, f64)> {
    let (dim, count) = velocities.shape();
    let is_held = |axis: &usize| velocities.row(*axis).norm_squared() <= HELD * noise * count as f64;
    let held: Vec<usize> = (0..dim).filter(is_held).collect();
    let is_within = |row: usize| held.iter().map(|&axis| matrix[(row, axis)].powi(2)).sum::<f64>() >= 1.0 - OTHERS;
    let concerned: Vec<usize> =
        held.iter().copied().filter(|&axis| matrix.column(axis).norm_squared() > CONCERNS).collect();
    if concerned.len() <= matrix.nrows() || !(0..matrix.nrows()).all(is_within) {
        return None;
    }
    let unit = |&at: &usize| DVector::from_fn(dim, |axis, _| f64::from(u8::from(axis == at))).transpose();
    let moving = (0..dim).filter(|axis| !held.contains(axis));
    let angle = moving.map(|axis| noise / velocities.row(axis).norm_squared()).sum::<f64>().sqrt();
    Some((DMatrix::from_rows(&concerned.iter().map(unit).collect::<Vec<_>>()), angle))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;

    proptest! {
        /// One row along any direction among held channels becomes a row for each; a moving channel beside them prevents it.
        #[test]
        fn held_channels_have_a_row_each(dim in 3usize..8, seed in any::<u64>(), noise in 1e-6..1.0f64) {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let held = rng.random_range(2..dim);
            let mut draw = |scale: f64| scale * (2.0 * rng.random::<f64>() - 1.0);
            let velocities = DMatrix::from_fn(dim, 40, |axis, _| draw(if axis < held { noise } else { 20.0 * noise }));
            let row = DMatrix::from_fn(1, dim, |_, axis| if axis < held { draw(0.5).signum() + draw(0.5) } else { 0.0 }).normalize();
            let (found, angle) = held_channels(&row, &velocities, noise * noise).unwrap();
            prop_assert_eq!(found, DMatrix::identity(held, dim));
            prop_assert!(angle < 0.05, "{angle}");
            let mut oblique = row.clone();
            oblique[(0, dim - 1)] = 0.5;
            prop_assert!(held_channels(&oblique.normalize(), &velocities, noise * noise).is_none());
            let single = DMatrix::from_fn(1, dim, |_, axis| f64::from(u8::from(axis == 0)));
            prop_assert!(held_channels(&single, &velocities, noise * noise).is_none());
        }
    }
}
