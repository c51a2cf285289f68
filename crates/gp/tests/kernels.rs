//! Covariances of slopes are second differences of those of potentials; fast matrices equal the literal ones.

use crate::drawn::{matrix, rng, vector};
use gp::{Block, Shape};
use nalgebra::DVector;
use proptest::prelude::*;

/// Whether two numbers agree to an absolute `tolerance`.
fn close(a: f64, b: f64, tolerance: f64) -> bool {
    (a - b).abs() <= tolerance
}

fn shapes() -> impl Strategy<Value = Shape> {
    prop_oneof![Just(Shape::SquaredExponential), Just(Shape::Matern52), Just(Shape::Matern32)]
}

fn potentials() -> impl Strategy<Value = Block> {
    prop_oneof![
        Just(Block::Linear),
        Just(Block::Quadratic),
        (shapes(), 0.3..3.0).prop_map(|(shape, scale)| Block::Potential(shape, scale)),
    ]
}

/// Central difference along `n`.
fn along(f: impl Fn(&DVector<f64>) -> f64, z: &DVector<f64>, n: &DVector<f64>) -> f64 {
    let step = 1e-4;
    (f(&(z + n * step)) - f(&(z - n * step))) / (2.0 * step)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// π = −∇f: (S4) is minus the slope of (S5) at the second state, (S3) minus that of (S4) at the first.
    #[test]
    fn slopes_are_differences_of_potentials(block in potentials(), dim in 1_usize..6, seed in any::<u64>()) {
        let rng = &mut rng(seed);
        let (z, z2) = (vector(dim, rng), vector(dim, rng));
        prop_assume!((&z - &z2).norm() > 0.1); // Matérn 3/2 has no third derivative at one state
        let (n, n2) = (vector(dim, rng).normalize(), vector(dim, rng).normalize());
        let potential = |z: &DVector<f64>, z2: &DVector<f64>| block.potential_potential(z.as_view(), z2.as_view()).expect("a potential");
        let potential_slope = |z: &DVector<f64>| block.potential_slope(z.as_view(), z2.as_view(), n2.as_view()).expect("a potential");
        let expected = -along(|at| potential(&z, at), &z2, &n2);
        prop_assert!(close(potential_slope(&z), expected, 1e-5), "{} {expected}", potential_slope(&z));
        let slope = block.slope_slope(z.as_view(), n.as_view(), z2.as_view(), n2.as_view());
        let expected = -along(potential_slope, &z, &n);
        prop_assert!(close(slope, expected, 1e-5), "{slope} {expected}");
    }

    /// The policy's covariance along any n is the slope's.
    #[test]
    fn policy_covariance_matches_the_slopes(
        block in prop_oneof![potentials(), Just(Block::Skew), (0.3..3.0).prop_map(Block::DivergenceFree)],
        dim in 2_usize..6, seed in any::<u64>(),
    ) {
        let rng = &mut rng(seed);
        let (z, z2, n, n2) = (vector(dim, rng), vector(dim, rng), vector(dim, rng), vector(dim, rng));
        let policy = block.policy_slope(z.as_view(), z2.as_view(), n2.as_view());
        let slope = block.slope_slope(z.as_view(), n.as_view(), z2.as_view(), n2.as_view());
        prop_assert!(close(policy.dot(&n), slope, 1e-12));
    }

    /// Policies of the rotational blocks are divergence-free.
    #[test]
    fn rotation_has_no_divergence(
        block in prop_oneof![Just(Block::Skew), (0.3..3.0).prop_map(Block::DivergenceFree)],
        dim in 2_usize..6, seed in any::<u64>(),
    ) {
        let rng = &mut rng(seed);
        let (z, z2, n2) = (vector(dim, rng), vector(dim, rng), vector(dim, rng));
        let policy = |z: &DVector<f64>| block.policy_slope(z.as_view(), z2.as_view(), n2.as_view());
        let axis = |k: usize| DVector::from_fn(dim, |i, _| f64::from(u8::from(i == k)));
        let divergence: f64 = (0..dim).map(|k| along(|z| policy(z)[k], &z, &axis(k))).sum();
        prop_assert!(close(divergence, 0.0, 1e-6), "{divergence}");
    }

    /// A covariance matrix of slopes is positive semidefinite.
    #[test]
    fn slope_covariance_is_positive_semidefinite(
        block in prop_oneof![potentials(), Just(Block::Skew), (0.3..3.0).prop_map(Block::DivergenceFree)],
        dim in 2_usize..5, count in 2_usize..12, seed in any::<u64>(),
    ) {
        let rng = &mut rng(seed);
        let (z, n) = (matrix(dim, count, rng), matrix(dim, count, rng));
        let entry = |i, j| block.slope_slope(z.column(i), n.column(i), z.column(j), n.column(j));
        let least = nalgebra::DMatrix::from_fn(count, count, entry).symmetric_eigenvalues().min();
        prop_assert!(least > -1e-10, "{least}");
    }
}
