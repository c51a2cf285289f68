//! Noise of recorded positions and velocities, without smoothing.

use motion::{Demonstrations, Trajectory};
use nalgebra::{DMatrix, DVector};

use crate::SmoothingError;

/// Fewer third differences than this say too little.
const NEEDED: usize = 50;

/// A median of absolute values times this is the standard deviation of a normal distribution.
const MEDIAN_TO_DEVIATION: f64 = 1.4826;

/// How noisy recorded positions are.
#[derive(Debug, Clone, PartialEq)]
pub struct PositionNoise {
    /// Standard deviation of the noise in each dimension, (n), in its unit.
    pub deviations: DVector<f64>,
    /// Share of the squared steps that is noise: 2 Σ_j σ̂_j² / mean ‖x_{i+1} − x_i‖². 0: positions are exact, 1: nothing
    /// but noise.
    pub step_share: f64,
}

impl PositionNoise {
    /// By third differences, robust against movement and switching constraints:
    /// σ̂_j = 1.4826 · median |x_{i+3} − 3x_{i+2} + 3x_{i+1} − x_i|_j / √20, over all trajectories together. Where stamps
    /// are uneven, the four factors are those of the divided difference, their squares' sum still 20.
    ///
    /// # Errors
    /// [`SmoothingError::TooFewDifferences`] below 50 differences per dimension, [`SmoothingError::NoMotion`] if no
    /// sample differs from the one before, [`SmoothingError::Overflow`].
    pub fn of(demonstrations: &Demonstrations) -> Result<Self, SmoothingError> {
        Self::of_series(demonstrations, Trajectory::states)
    }

    /// Of what a trajectory holds for every sample, (n, N).
    fn of_series(
        demonstrations: &Demonstrations,
        series: impl Fn(&Trajectory) -> &DMatrix<f64>,
    ) -> Result<Self, SmoothingError> {
        let trajectories = demonstrations.trajectories();
        let found = trajectories.iter().map(|trajectory| trajectory.n_samples().saturating_sub(3)).sum();
        if found < NEEDED {
            return Err(SmoothingError::TooFewDifferences { found, needed: NEEDED });
        }
        let dim = demonstrations.dim();
        let mut differences = Vec::with_capacity(found);
        let deviations = DVector::from_fn(dim, |axis, _| {
            differences.clear();
            for trajectory in trajectories {
                let values = series(trajectory).as_slice();
                differences.extend(third_differences(values, dim, axis, trajectory.times()));
            }
            MEDIAN_TO_DEVIATION * median(&mut differences).unwrap_or(0.0) / 20f64.sqrt()
        });
        let mut step = DVector::zeros(dim);
        let (mut sum, mut count) = (0.0, 0);
        for values in trajectories.iter().map(&series) {
            for i in 1..values.ncols() {
                values.column(i).sub_to(&values.column(i - 1), &mut step);
                sum += step.norm_squared();
            }
            count += values.ncols() - 1;
        }
        let mean_step = sum / count as f64;
        if mean_step == 0.0 {
            return Err(SmoothingError::NoMotion);
        }
        let step_share = 2.0 * deviations.norm_squared() / mean_step;
        if mean_step.is_finite() && step_share.is_finite() {
            Ok(PositionNoise { deviations, step_share })
        } else {
            Err(SmoothingError::Overflow)
        }
    }
}

/// How noisy recorded velocities are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VelocityNoise {
    /// Variance of the noise of a velocity, summed over the axes, in squared units of the state per second.
    pub variance: f64,
    /// Share of the mean |u|² that is noise.
    pub share: f64,
}

impl VelocityNoise {
    /// By third differences of the velocities, as [`PositionNoise::of`] those of positions; none where some movement has no velocities, or
    /// where they are too few, all the same or too large for an estimate.
    pub fn of(demonstrations: &Demonstrations) -> Option<Self> {
        if demonstrations.trajectories().iter().any(|trajectory| trajectory.velocities().is_none()) {
            return None;
        }
        let noise = PositionNoise::of_series(demonstrations, |of| of.velocities().unwrap_or(of.states())).ok()?;
        let each = demonstrations.trajectories().iter().filter_map(Trajectory::velocities);
        let (power, count) = each.fold((0.0, 0), |(power, count), u| (power + u.norm_squared(), count + u.ncols()));
        let variance = noise.deviations.norm_squared();
        Some(VelocityNoise { variance, share: variance / (power / count as f64) })
    }
}

/// |x_{i+3} − 3x_{i+2} + 3x_{i+1} − x_i| of one axis; `rows` holds x_ij at `i * dim + j`.
pub(crate) fn third_differences<'a>(
    rows: &'a [f64],
    dim: usize,
    axis: usize,
    times: Option<&'a [f64]>,
) -> impl Iterator<Item = f64> + 'a {
    let x = move |i: usize| rows[i * dim + axis];
    (3..rows.len() / dim).map(move |i| match times {
        None => (x(i) - x(i - 3) - 3.0 * (x(i - 1) - x(i - 2))).abs(),
        Some(times) => {
            let factors = divided_difference(&times[i - 3..=i]);
            // Differences first, so that what the samples share is not rounded.
            (1..4).map(|k| factors[k] * (x(i - 3 + k) - x(i - 3))).sum::<f64>().abs()
        }
    })
}

/// Factors c_k ∝ 1/Π_{j ≠ k}(t_k − t_j) of four samples, which vanish on parabolas; Σ c_k² = 20, as on even stamps.
fn divided_difference(times: &[f64]) -> [f64; 4] {
    let span = times[3] - times[0];
    let product = |k: usize| (0..4).filter(|&j| j != k).map(|j| (times[k] - times[j]) / span).product::<f64>();
    let factors = [0, 1, 2, 3].map(|k| 1.0 / product(k));
    let norm = (factors.iter().map(|factor| factor * factor).sum::<f64>() / 20.0).sqrt();
    factors.map(|factor| factor / norm)
}

/// The middle value, or the mean of both; none of nothing.
pub(crate) fn median(values: &mut [f64]) -> Option<f64> {
    let middle = values.len() / 2;
    if values.is_empty() {
        return None;
    }
    let odd = values.len() % 2 == 1;
    let (below, &mut upper, _) = values.select_nth_unstable_by(middle, f64::total_cmp);
    if odd {
        return Some(upper);
    }
    let lower = below.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    Some(lower + (upper - lower) / 2.0)
}
