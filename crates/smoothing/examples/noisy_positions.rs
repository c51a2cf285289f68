//! Estimates the noise of recorded positions and computes velocities from them.

#![allow(clippy::print_stdout, reason = "a program")]

use std::error::Error;

use motion::Demonstrations;
use nalgebra::DMatrix;
use rand::rngs::StdRng;
use rand::{RngExt as _, SeedableRng as _};
use rand_distr::StandardNormal;
use smoothing::{PositionNoise, Smoother};

fn main() -> Result<(), Box<dyn Error>> {
    // Eight movements towards the origin at 50 Hz, π(x) = −x, with noise of 1 mm.
    let mut rng = StdRng::seed_from_u64(1);
    let time_step = 0.02;
    let truth: Vec<DMatrix<f64>> = (0..8).map(|k| movement(f64::from(k), time_step)).collect();
    let noisy = truth.iter().map(|states| states.map(|x| x + 1e-3 * rng.sample::<f64, _>(StandardNormal)));
    let demonstrations = Demonstrations::from_states(noisy, time_step)?;

    let noise = PositionNoise::of(&demonstrations)?;
    println!("noise of 0.0010 m, estimated: {:.4?} m", noise.deviations.as_slice());
    println!("share of the squared steps that is noise: {:.0} %", 100.0 * noise.step_share);

    let smoothed = Smoother::default().smooth(&demonstrations)?;
    let (mut of_steps, mut of_smoother, mut expected, mut count) = (0.0, 0.0, 0.0, 0);
    for ((states, recorded), movement) in truth.iter().zip(demonstrations.trajectories()).zip(&smoothed.movements) {
        let steps = recorded.step_velocities();
        of_steps += (&steps + states.columns(0, steps.ncols())).norm_squared();
        of_smoother += (&movement.velocities + states).norm_squared();
        expected += 2.0 * movement.velocity_variance.sum();
        count += states.len();
    }
    let root_mean = |squares: f64| (squares / count as f64).sqrt();
    println!("velocity error of differences  {:.4} m/s", root_mean(of_steps));
    println!("velocity error of the smoother {:.4} m/s, it expects {:.4}", root_mean(of_smoother), root_mean(expected));
    Ok(())
}

/// A movement towards the origin in metres, (2, 100).
fn movement(angle: f64, time_step: f64) -> DMatrix<f64> {
    let start = [0.5 * angle.cos(), 0.5 * angle.sin()];
    DMatrix::from_fn(2, 100, |axis, i| start[axis] * (-time_step * i as f64).exp())
}
