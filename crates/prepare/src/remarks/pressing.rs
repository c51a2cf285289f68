//! A direction in which the velocity is the same wherever the hand is.

use motion::{Demonstrations, Verdict};
use nalgebra::{DMatrix, DVector};

use crate::direction::direction_by_channels;
use crate::notes::Notes;
use crate::numbers::{percent, short};
use crate::samples::noise::{Noise, velocities, velocity_variance};
use crate::StateChannel;

/// Largest deviation of a steady velocity, as a share of its mean: a surface tilted by ten degrees reaches a third.
const STEADY: f64 = 0.5;
/// Its largest variance, as a share of what the next direction varies by.
const UNLIKE_OTHERS: f64 = 0.15;
/// A mean below this share of the speed is no movement.
const MOVES: f64 = 0.01;

/// Says that a press, a conveyor or a clock hides the policy in some direction.
pub(super) fn remark(demonstrations: &Demonstrations, state: &[StateChannel], noise: &Noise, notes: &mut Notes) {
    let Some(steady) = steady(demonstrations, noise) else { return };
    let direction = direction_by_channels(steady.direction.as_slice(), state);
    notes.found(
        Verdict::Doubtful,
        format!(
            "the velocity along {direction} is the same wherever the hand is ({} ± {}, {} of the speed)",
            short(steady.mean.abs()),
            short(steady.deviation),
            percent(steady.share)
        ),
        "a press, a conveyor or a clock among the channels hides the policy there: record movements without it, or with the surface turned by 30 degrees and more",
    );
}

struct Steady {
    direction: DVector<f64>,
    mean: f64,
    deviation: f64,
    /// |mean| over the root mean square of the speed.
    share: f64,
}

/// The direction of least variance, if its mean stands out.
fn steady(demonstrations: &Demonstrations, noise: &Noise) -> Option<Steady> {
    let dim = demonstrations.dim();
    let velocities: Vec<DVector<f64>> = velocities(demonstrations).collect();
    if dim < 2 || velocities.len() < 2 {
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
    let known = velocity_variance(demonstrations, noise);
    let variance = |at: usize| (eigen.eigenvalues[at] - known).max(0.0);
    let next = (0..dim).filter(|&at| at != least).map(variance).fold(f64::INFINITY, f64::min);
    let direction = eigen.eigenvectors.column(least).into_owned();
    let mean = direction.dot(&mean);
    let deviation = variance(least).sqrt();
    let is_steady = deviation <= STEADY * mean.abs()
        && variance(least) <= UNLIKE_OTHERS * next
        && mean.powi(2) > MOVES * MOVES * power;
    is_steady.then(|| Steady { direction, mean, deviation, share: mean.abs() / power.sqrt() })
}
