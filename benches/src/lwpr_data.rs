//! Samples of a quadratic potential along constrained movements, in any number of dimensions.

use nalgebra::{DMatrix, DVector};
use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

const TRAJECTORIES: usize = 100;
const SAMPLES: usize = 100;
const TIME_STEP: f64 = 0.2;
const NOISE: f64 = 0.02;

/// Training data of a regression benchmark.
pub struct PotentialSamples {
    /// Inputs (d, 10 000).
    pub xs: DMatrix<f64>,
    /// Values of the potential (1, 10 000).
    pub ys: DMatrix<f64>,
    /// Initial metric suitable for the dimension.
    pub init_d: f64,
}

impl PotentialSamples {
    /// Standard deviation of the targets.
    pub fn spread(&self) -> f64 {
        self.ys.row(0).transpose().variance().sqrt()
    }
}

/// 100 movements of 100 samples down φ(x) = .05 |x|², each under one random constraint: ẋ = (I − aaᵀ)(−∇φ) with |a| = 1.
///
/// They start uniformly in a cube of 2 (d = 2) or 3 dimensions, embedded in ℝ^d by a random orthonormal basis, with noise.
pub fn potential_samples(d: usize, rng: &mut impl Rng) -> PotentialSamples {
    let k = if d == 2 { 2 } else { 3 };
    let basis = DMatrix::from_fn(d, k, |_, _| rng.sample::<f64, _>(StandardNormal)).qr().q();
    let mut xs = DMatrix::zeros(d, TRAJECTORIES * SAMPLES);
    for trajectory in 0..TRAJECTORIES {
        let start = DVector::from_fn(basis.ncols(), |_, _| rng.random_range(-1.0..1.0));
        let noise = DVector::from_fn(d, |_, _| NOISE * rng.sample::<f64, _>(StandardNormal));
        let constraint = DVector::from_fn(d, |_, _| rng.sample::<f64, _>(StandardNormal)).normalize();
        let mut x = &basis * start + noise;
        for sample in 0..SAMPLES {
            xs.column_mut(trajectory * SAMPLES + sample).copy_from(&x);
            let downhill = -0.1 * &x;
            let allowed = &downhill - &constraint * constraint.dot(&downhill);
            x += TIME_STEP * allowed;
        }
    }
    let ys = DMatrix::from_fn(1, xs.ncols(), |_, i| 0.05 * xs.column(i).norm_squared());
    let init_d = match d {
        0..=3 => 25.0,
        4..=9 => 10.0,
        _ => 5.0,
    };
    PotentialSamples { xs, ys, init_d }
}
