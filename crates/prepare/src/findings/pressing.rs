//! Detects a direction in which the velocity is the same everywhere.

use motion::{Demonstrations, Finding, Trajectory};
use nalgebra::{DMatrix, DVector};

use crate::StateChannel;
use crate::direction::direction_by_channels;
use crate::numbers::{percent, short};

/// Velocities are averaged over parts of a movement to reduce noise: a quarter, or so many samples if that is less.
const PARTS: usize = 4;
const SAMPLES: usize = 50;
/// Maximum deviation of a steady velocity, as a share of its mean; a surface tilted by ten degrees reaches a fifth.
const STEADY: f64 = 0.5;
/// Maximum variance of a steady velocity, as a share of the variance in the next direction.
const UNLIKE_OTHERS: f64 = 0.15;
/// A mean below this share of the speed is no movement; the coverage of directions reports that case.
const MOVES: f64 = 0.05;

/// Reports that a press, a conveyor or a clock hides the policy in some direction, in which the velocity is the same in all movements and
/// not 0. `state` names the channels of the demonstrations, (n).
pub(super) fn pressing(demonstrations: &Demonstrations, state: &[StateChannel]) -> Option<Finding> {
    let steady = steady(demonstrations)?;
    let direction = direction_by_channels(steady.direction.as_slice(), state);
    Some(Finding::doubt(
        format!(
            "the velocity along {direction} is the same everywhere ({} ± {}, {} of the speed)",
            short(steady.mean.abs()),
            short(steady.deviation),
            percent(steady.share)
        ),
        "a press, a conveyor or a clock among the channels hides the policy there: record movements without it, or with the surface turned in several directions",
    ))
}

struct Steady {
    direction: DVector<f64>,
    mean: f64,
    deviation: f64,
    /// |mean| divided by the root mean square of the speed.
    share: f64,
}

/// The direction of least variance, if its mean stands out.
fn steady(demonstrations: &Demonstrations) -> Option<Steady> {
    let dim = demonstrations.dim();
    let velocities: Vec<DVector<f64>> = demonstrations.trajectories().iter().flat_map(means).collect();
    if dim < 2 || velocities.len() <= dim {
        return None;
    }
    let samples = velocities.len() as f64;
    let mean = velocities.iter().sum::<DVector<f64>>() / samples;
    let power = velocities.iter().map(nalgebra::Matrix::norm_squared).sum::<f64>() / samples;
    let mut scatter = DMatrix::zeros(dim, dim);
    for velocity in &velocities {
        let away = velocity - &mean;
        scatter.ger(1.0 / samples, &away, &away, 1.0);
    }
    let eigen = scatter.symmetric_eigen();
    let least = eigen.eigenvalues.imin();
    let variance = |at: usize| eigen.eigenvalues[at].max(0.0);
    let next = (0..dim).filter(|&at| at != least).map(variance).fold(f64::INFINITY, f64::min);
    let direction = eigen.eigenvectors.column(least).into_owned();
    let mean = direction.dot(&mean);
    // A deviation caused by rounding counts as 0.
    let deviation = (variance(least).sqrt() / mean.abs() * 1e3).round() * mean.abs() / 1e3;
    let is_steady = deviation <= STEADY * mean.abs()
        && variance(least) <= UNLIKE_OTHERS * next
        && mean.powi(2) > MOVES * MOVES * power;
    is_steady.then(|| Steady { direction, mean, deviation, share: mean.abs() / power.sqrt() })
}

/// Mean velocities over the parts of a movement, (n) each.
fn means(movement: &Trajectory) -> Vec<DVector<f64>> {
    let last = movement.n_samples() - 1;
    let length = (last / PARTS).clamp(1, SAMPLES);
    let mean = |from: usize| match movement.velocities() {
        Some(velocities) => velocities.columns(from, length).column_mean(),
        None => (movement.state(from + length) - movement.state(from)) / movement.seconds(from, from + length),
    };
    (0..last / length).map(|part| mean(part * length)).collect()
}
