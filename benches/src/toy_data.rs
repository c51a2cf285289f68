use motion::Demonstrations;
use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

/// Movements down 0.05‖x‖² from starts uniform in [−2, 2)ⁿ, one second per step, under one random constraint at a time
/// that is redrawn every 20 steps: the toy system (Sec. 4.1) in any number of dimensions.
///
/// # Panics
/// If there is no trajectory, no dimension, or fewer than two samples.
pub fn toy_demonstrations(seed: u64, n_trajectories: usize, n_samples: usize, dim: usize) -> Demonstrations {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let movements = (0..n_trajectories).map(|_| movement(&mut rng, n_samples, dim));
    Demonstrations::from_states(movements.collect::<Vec<_>>(), 1.0).expect("finite states of one dimension")
}

fn movement(rng: &mut ChaCha8Rng, n_samples: usize, dim: usize) -> DMatrix<f64> {
    let mut x = DVector::from_fn(dim, |_, _| rng.random_range(-2.0..2.0));
    let mut normal = DVector::zeros(dim);
    let mut states = DMatrix::zeros(dim, n_samples);
    for sample in 0..n_samples {
        if sample % 20 == 0 {
            normal = DVector::from_fn(dim, |_, _| rng.sample::<f64, _>(StandardNormal)).normalize();
        }
        states.set_column(sample, &x);
        let wanted = -0.1 * &x;
        x += &wanted - &normal * normal.dot(&wanted);
    }
    states
}
