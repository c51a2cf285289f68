//! Movements under random constraints, with their policies.
pub(crate) mod many;
pub(crate) mod movement;

use gp::Rows;
use motion::{Policy, SampleIndex};
use nalgebra::{DMatrix, DVector};
use rand::{Rng, RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

pub(crate) fn rng(seed: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(seed)
}

pub(crate) fn vector<R: Rng>(dim: usize, rng: &mut R) -> DVector<f64> {
    DVector::from_fn(dim, |_, _| rng.random_range(-1.5..1.5))
}

pub(crate) fn matrix<R: Rng>(rows: usize, columns: usize, rng: &mut R) -> DMatrix<f64> {
    DMatrix::from_fn(rows, columns, |_, _| rng.random_range(-1.0..1.0))
}

/// A standard normal number.
pub(crate) fn normal<R: Rng>(rng: &mut R) -> f64 {
    rng.sample(rand_distr::StandardNormal)
}

/// nUPE of a policy, given states and the true actions there, (n, Q) each.
pub(crate) fn nupe(policy: &dyn Policy, (states, truth): &(DMatrix<f64>, DMatrix<f64>)) -> f64 {
    let learnt: Vec<DVector<f64>> = states.column_iter().map(|x| policy.action(x)).collect();
    metrics::nupe(truth, &DMatrix::from_columns(&learnt)).expect("a score")
}

/// Minima of three wells; systems of lower dimension take the first coordinates.
pub(crate) const WELLS: [[f64; 6]; 3] =
    [[0.5, 0.3, -0.4, 0.2, 0.1, -0.5], [-0.6, 0.2, 0.3, -0.3, 0.4, 0.2], [0.1, -0.6, 0.2, 0.5, -0.4, 0.3]];

/// Scattered rows: `per` samples of each trajectory. Each velocity is the policy projected by one random constraint per
/// sample.
pub(crate) fn rows<R: Rng>(
    dim: usize,
    (trajectories, per): (usize, usize),
    policy: impl Fn(&DVector<f64>) -> DVector<f64>,
    rng: &mut R,
) -> Rows {
    let count = trajectories * per;
    let (mut states, mut velocities) = (DMatrix::zeros(dim, count), DMatrix::zeros(dim, count));
    for row in 0..count {
        let x = vector(dim, rng);
        let a = vector(dim, rng);
        let u = policy(&x);
        let left = if dim > 1 { &u - &a * (a.dot(&u) / a.norm_squared()) } else { u };
        states.set_column(row, &x);
        velocities.set_column(row, &left);
    }
    let indices = (0..count).map(|row| SampleIndex { trajectory: row / per, sample: row % per }).collect();
    Rows::new(states, velocities, indices).expect("finite rows")
}

/// −∇ of a smooth asymmetric potential.
pub(crate) fn descent(x: &DVector<f64>) -> DVector<f64> {
    DVector::from_fn(x.len(), |k, _| (x[k] + 0.3 * x[(k + 1) % x.len()]).cos() - 0.4 * x[k] + 0.2)
        + DVector::from_fn(x.len(), |k, _| {
            let before = (k + x.len() - 1) % x.len();
            0.3 * (x[before] + 0.3 * x[k]).cos()
        })
}
