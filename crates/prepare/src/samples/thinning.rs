//! Averages many noisy samples to fewer, more exact ones.

use motion::{Demonstrations, MotionError, Subject, Trajectory, upper_median};
use nalgebra::DMatrix;

use crate::notes::Notes;
use crate::numbers::percent_of_all;
use crate::samples::noise::{Noise, squared_steps};

/// Samples are averaged until noise is at most this share of the squared steps.
const CALM: f64 = 0.3;
/// Minimum number of samples that movements retain.
const LEAST: usize = 40;

/// Number of successive samples that are averaged to one; 1 leaves all unchanged.
///
/// The mean of k samples has a k-th of their noise variance, and steps between such means are k times as long.
pub(crate) fn decide(demonstrations: &Demonstrations, noise: &Noise, notes: &mut Notes) -> usize {
    let Some(deviations) = &noise.positions else { return 1 };
    let variance: f64 = deviations.iter().map(|sd| sd * sd).sum();
    let lengths = demonstrations.trajectories().iter().map(|movement| movement.n_samples() as f64);
    let usual = upper_median(lengths.collect()).expect("there is a movement") as usize;
    let mut taken = 1;
    let mut share = noise.step_share;
    while share > CALM && usual / (2 * taken) >= LEAST {
        taken *= 2;
        let Ok(fewer) = thinned(demonstrations, taken) else { break };
        let (sum, count) = squared_steps(&fewer);
        share = 2.0 * variance / taken as f64 / (sum / count as f64);
    }
    if taken > 1 {
        let why = format!(
            "noise share of the squared steps: {} before, {} after",
            percent_of_all(noise.step_share),
            percent_of_all(share)
        );
        notes.decided(Subject::Averaging, format!("over {taken} samples"), why);
    }
    taken
}

/// Averages each `taken` successive samples; a shorter remainder is dropped. Movements of fewer than two means are
/// unchanged.
///
/// # Errors
/// If means overflow.
///
/// # Panics
/// If `taken` is 0.
pub fn thinned(demonstrations: &Demonstrations, taken: usize) -> Result<Demonstrations, MotionError> {
    let movements = demonstrations.trajectories().iter().map(|movement| means(movement, taken));
    Demonstrations::new(movements.collect::<Result<_, _>>()?)
}

fn means(movement: &Trajectory, taken: usize) -> Result<Trajectory, MotionError> {
    let count = movement.n_samples() / taken;
    if taken == 1 || count < 2 {
        return Ok(movement.clone());
    }
    let means_of = |values: &DMatrix<f64>| {
        let means: Vec<_> = (0..count).map(|at| values.columns(at * taken, taken).column_mean()).collect();
        DMatrix::from_columns(&means)
    };
    let thinned = Trajectory::new(means_of(movement.states()), movement.time_step() * taken as f64)?
        .with_context(movement.context().clone())?
        .with_labels(movement.labels().and_then(|labels| labels.chosen((0..count).map(|at| at * taken + taken / 2))));
    let thinned = match movement.times() {
        None => thinned,
        Some(times) => {
            let mean = |at: usize| times[at * taken..(at + 1) * taken].iter().sum::<f64>() / taken as f64;
            thinned.with_times((0..count).map(mean).collect())?
        }
    };
    match movement.velocities() {
        None => Ok(thinned),
        Some(velocities) => thinned.with_velocities(means_of(velocities)),
    }
}
