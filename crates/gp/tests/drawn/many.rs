//! Data sets with any number of movements: constraint planes at random angles, with one switch in each movement, and noise on
//! velocities.

use gp::Rows;
use motion::SampleIndex;
use nalgebra::{DMatrix, DVector};
use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

use super::movement::{Constraint, Integration, Movement};
use super::{WELLS, normal};

/// A gradient of a potential on [−1, 1]ⁿ.
pub(crate) type Gradient = fn(&[f64]) -> Vec<f64>;

pub(crate) fn wells(x: &[f64]) -> Vec<f64> {
    let mut gradient: Vec<f64> = x.iter().map(|x| 0.6 * x).collect();
    for centre in WELLS {
        let well = (-x.iter().zip(&centre).map(|(x, c)| (x - c).powi(2)).sum::<f64>() * 2.0).exp();
        for (k, gradient) in gradient.iter_mut().enumerate() {
            *gradient += 4.0 * (x[k] - centre[k]) * well;
        }
    }
    gradient
}

pub(crate) fn sinusoid(x: &[f64]) -> Vec<f64> {
    vec![2.0 * (2.0 * x[0]).cos() * (x[1]).cos(), -(2.0 * x[0]).sin() * x[1].sin()]
}

/// Rows, and states of other movements with the policy there, (n, Q) each.
pub(crate) struct Set {
    pub(crate) rows: Rows,
    pub(crate) fresh: (DMatrix<f64>, DMatrix<f64>),
}

/// A set of `movements` with `samples` each, with noise on velocities as a share of their root mean square, and twenty new
/// movements.
pub(crate) fn set(gradient: Gradient, dim: usize, (movements, samples): (usize, usize), noise: f64, seed: u64) -> Set {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let fresh = record((gradient, dim), (20, samples), &mut rng);
    let (states, mut velocities) = record((gradient, dim), (movements, samples), &mut rng);
    let rms = (velocities.iter().map(DVector::norm_squared).sum::<f64>() / velocities.len() as f64).sqrt();
    for velocity in &mut velocities {
        velocity.apply(|u| *u += noise * rms * normal(&mut rng));
    }
    let count = states.len();
    let indices = (0..count).map(|row| SampleIndex { trajectory: row / samples, sample: row % samples }).collect();
    let rows =
        Rows::new(DMatrix::from_columns(&states), DMatrix::from_columns(&velocities), indices).expect("finite rows");
    let rows =
        if noise > 0.0 { rows.with_variances(vec![(noise * rms).powi(2); count]).expect("variances") } else { rows };
    Set { rows, fresh: with_policy(gradient, &fresh.0) }
}

/// Groups of twenty new movements: every fifth of 500 states, and the policy there, (n, 2000) each.
pub(crate) fn new_movements(
    gradient: Gradient,
    dim: usize,
    groups: usize,
    seed: u64,
) -> Vec<(DMatrix<f64>, DMatrix<f64>)> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut group = || {
        let (states, _) = record((gradient, dim), (20, 500), &mut rng);
        let every_fifth: Vec<DVector<f64>> = states.into_iter().step_by(5).collect();
        with_policy(gradient, &every_fifth)
    };
    (0..groups).map(|_| group()).collect()
}

/// States and velocities, sample by sample.
fn record(
    (gradient, dim): (Gradient, usize),
    (movements, samples): (usize, usize),
    rng: &mut ChaCha8Rng,
) -> (Vec<DVector<f64>>, Vec<DVector<f64>>) {
    let policy = |x: &DVector<f64>| policy(gradient, x);
    let (mut states, mut velocities) = (Vec::new(), Vec::new());
    for _ in 0..movements {
        let mut movement = Movement {
            policy: &policy,
            integration: Integration::Euler,
            time_step: 2.0 / samples as f64,
            state: DVector::from_fn(dim, |_, _| rng.random_range(-1.0..1.0)),
            constraint: Constraint::none(dim),
        };
        for sample in 0..samples {
            if sample == 0 || sample == samples / 2 {
                let basis = DMatrix::from_fn(dim, 1, |_, _| normal(rng)).normalize();
                movement.constraint = Constraint::Fixed { basis, push: DVector::zeros(dim) };
            }
            let (x, u) = movement.sample();
            states.push(x);
            velocities.push(u);
        }
    }
    (states, velocities)
}

fn policy(gradient: Gradient, x: &DVector<f64>) -> DVector<f64> {
    -DVector::from_vec(gradient(x.as_slice()))
}

fn with_policy(gradient: Gradient, states: &[DVector<f64>]) -> (DMatrix<f64>, DMatrix<f64>) {
    let truth: Vec<_> = states.iter().map(|x| policy(gradient, x)).collect();
    (DMatrix::from_columns(states), DMatrix::from_columns(&truth))
}
