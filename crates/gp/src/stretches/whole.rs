//! (S32): movements whose constraint never switched.

use nalgebra::DMatrix;

use crate::stretches::partition::SPARE;

/// Maximum standard deviation of a direction's angle.
const ANGLE: f64 = 0.25;
/// Tolerance of the residuals outside the plane, in standard deviations of χ².
const LEAVES: f64 = 3.0;
/// Number of samples before and after a place that are tested for a jump of the velocities.
const NEAR: usize = 8;

/// The least rank of a plane through 0 that contains all velocities, (n, N), of a movement up to noise. The rank is at most `most` (the
/// largest of its segments), or 1; `None` if there is no such plane. A plane of higher dimension might contain two stretches of lower
/// dimension.
pub(super) fn whole(velocities: &DMatrix<f64>, most: usize, noise: f64) -> Option<usize> {
    let (dim, count) = velocities.shape();
    let mut eigenvalues = (velocities * velocities.transpose()).symmetric_eigenvalues().as_slice().to_vec();
    eigenvalues.sort_by(f64::total_cmp);
    let outside = |rank: usize| eigenvalues[..dim - rank].iter().map(|value| value.max(0.0)).sum::<f64>() / noise;
    let allowed = |rank: usize| {
        let freedom = ((dim - rank) * (count - 1)) as f64;
        freedom + LEAVES * (2.0 * freedom).sqrt()
    };
    // In one dimension there is no plane.
    (1..=most.max(1).min(dim - 1)).filter(|rank| count >= rank + SPARE).find(|&rank| outside(rank) <= allowed(rank))
}

/// Whether velocities, (n, N), jump (S45): somewhere the residual sum of squares of two lines in time, one through the samples before and
/// one through those after, is less than half that of a cubic, which has as many coefficients and leaves more than noise.
pub(super) fn jumps(velocities: &DMatrix<f64>, noise: f64) -> bool {
    let polynomials = |count: usize, coefficients: usize| {
        let time = |at: usize| 2.0 * at as f64 / (count - 1) as f64 - 1.0;
        DMatrix::from_fn(count, coefficients, |at, power| time(at).powf(power as f64)).qr().q()
    };
    let (line, cubic) = (polynomials(NEAR, 2), polynomials(2 * NEAR, 4));
    let left = |begin: usize, basis: &DMatrix<f64>| {
        let some = velocities.columns(begin, basis.nrows());
        (some - some * basis * basis.transpose()).norm_squared()
    };
    let least = noise * (2 * NEAR * velocities.nrows()) as f64;
    (0..(velocities.ncols() + 1).saturating_sub(2 * NEAR)).any(|at| {
        let of_cubic = left(at, &cubic);
        of_cubic > least && 2.0 * (left(at, &line) + left(at + NEAR, &line)) < of_cubic
    })
}

/// The least singular value of `count` velocities along a direction whose angle is certain enough; s√N of it is noise.
pub(super) fn least_length(count: usize, noise: f64) -> f64 {
    let half = 0.5 / ANGLE;
    noise.sqrt() * (half + (half * half + count as f64).sqrt())
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};
    use proptest::prelude::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;
    use crate::stretches::centred;

    /// Velocities on a random plane of this rank, at a distance from 0, with uniform noise of variance 1e-4.
    fn in_plane(dim: usize, rank: usize, count: usize, rng: &mut ChaCha8Rng) -> DMatrix<f64> {
        let mut draw = |rows, columns| DMatrix::from_fn(rows, columns, |_, _| 2.0 * rng.random::<f64>() - 1.0);
        let (basis, push) = (draw(dim, rank).qr().q(), DVector::from_column_slice(draw(dim, 1).as_slice()));
        let mut velocities = &basis * draw(rank, count) + draw(dim, count) * 1e-2 * 3.0_f64.sqrt();
        velocities.column_iter_mut().for_each(|mut velocity| velocity += &push);
        velocities
    }

    proptest! {
        /// One plane with a push is found with its rank, whatever the ranks of its segments.
        #[test]
        fn a_movement_without_switch_is_whole(dim in 2usize..6, count in 30usize..100, seed in any::<u64>()) {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let (_, line) = centred(&in_plane(dim, 1, count, &mut rng));
            prop_assert_eq!(whole(&line, 0, 1e-4), Some(1));
            let (_, plane) = centred(&in_plane(dim, dim - 1, count, &mut rng));
            prop_assert_eq!(whole(&plane, dim - 1, 1e-4), Some(dim - 1));
        }

        /// Two lines lie in one plane, which is not accepted; neither are two planes in two dimensions.
        #[test]
        fn a_movement_with_a_switch_is_not(count in 20usize..60, seed in any::<u64>()) {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let mut both = DMatrix::zeros(3, 2 * count);
            for (part, axis) in [(0, 0), (count, 1)] {
                (part..part + count).for_each(|at| both[(axis, at)] = 2.0 * rng.random::<f64>() - 1.0);
            }
            prop_assert_eq!(whole(&both, 1, 1e-4), None);
            prop_assert_eq!(whole(&both.rows(0, 2).into_owned(), 1, 1e-4), None);
        }

        /// (S23): at the least length, the angle's standard deviation s/ℓ has the maximum allowed value.
        #[test]
        fn the_least_length_is_that_of_the_largest_angle(count in 1usize..1000, deviation in 0.01f64..10.0) {
            let least = least_length(count, deviation * deviation);
            let length = least - count as f64 * deviation * deviation / least;
            prop_assert!((deviation / length / ANGLE - 1.0).abs() < 1e-9);
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]

        /// Nearly all movements that jump by twenty standard deviations of the noise are found, and hardly any of those that decay, or turn
        /// with at least thirty samples per turn, or are noise alone.
        #[test]
        fn jumps_are_found(
            dim in 2usize..5,
            at in 20usize..60,
            factor in 0.3f64..0.99,
            turn in 30.0f64..100.0,
            deviation in 1e-4f64..1e-2,
            seed in any::<u64>(),
        ) {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let mut of_forty = |velocity: &dyn Fn(usize, usize) -> f64| {
                let noise = |rng: &mut ChaCha8Rng| deviation * 3.0_f64.sqrt() * (2.0 * rng.random::<f64>() - 1.0);
                let one = |_: &usize| {
                    let moving = DMatrix::from_fn(dim, 80, |axis, sample| velocity(axis, sample) + noise(&mut rng));
                    jumps(&moving, deviation.powi(2))
                };
                (0..40).filter(one).count()
            };
            prop_assert!(of_forty(&|_, _| 0.0) <= 4);
            prop_assert!(of_forty(&|axis, sample| factor.powf((sample + axis) as f64)) <= 4);
            prop_assert!(of_forty(&|axis, sample| (std::f64::consts::TAU * (sample + axis) as f64 / turn).sin()) <= 4);
            let step = |axis, sample| if axis == 0 && sample >= at { 20.0 * deviation } else { 0.0 };
            prop_assert!(of_forty(&step) >= 36);
        }
    }
}
