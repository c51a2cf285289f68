//! Noise of recorded positions and velocities, estimated without smoothing.

use motion::{Demonstrations, Trajectory, median};
use nalgebra::{DMatrix, DVector};

use crate::SmoothingError;

/// Least number of third differences for an estimate.
const NEEDED: usize = 50;

/// The standard deviation of a normal distribution is the median absolute value times this.
const MEDIAN_TO_DEVIATION: f64 = 1.4826;

/// Least share of a white noise's variance that fifth differences find; less if there are few of them.
const WHITE: f64 = 0.5;

/// Noise of recorded positions.
#[derive(Debug, Clone, PartialEq)]
pub struct PositionNoise {
    /// Standard deviation of the noise in each dimension, (n), in its unit.
    pub deviations: DVector<f64>,
    /// Share of the squared steps that is noise: 2 Σ_j σ̂_j² / mean ‖x_{i+1} − x_i‖². 0 means exact positions, 1 nothing but noise.
    pub step_share: f64,
}

impl PositionNoise {
    /// Estimates the noise by third differences, robustly against movement and switching constraints:
    /// σ̂_j = 1.4826 · median |x_{i+3} − 3x_{i+2} + 3x_{i+1} − x_i|_j / √20, over all trajectories together. For uneven stamps,
    /// the four factors are those of the divided difference; the sum of their squares is still 20.
    ///
    /// # Errors
    /// [`SmoothingError::TooFewDifferences`] below 50 differences per dimension, [`SmoothingError::NoMotion`] if no sample differs from the
    /// one before, [`SmoothingError::Overflow`].
    pub fn of(demonstrations: &Demonstrations) -> Result<Self, SmoothingError> {
        Self::of_series(demonstrations, Trajectory::states)
    }

    /// The noise of a series with one column per sample of a trajectory, (n, N).
    fn of_series(
        demonstrations: &Demonstrations,
        series: impl Fn(&Trajectory) -> &DMatrix<f64>,
    ) -> Result<Self, SmoothingError> {
        let trajectories = demonstrations.trajectories();
        let dim = demonstrations.dim();
        let deviations = deviations::<4>(demonstrations, &series)?;
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

/// Noise of recorded velocities.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VelocityNoise {
    /// Noise variance of a velocity, summed over the axes, in squared units of the state per second.
    pub variance: f64,
    /// Share of the mean |u|² that is noise.
    pub share: f64,
    /// Whether fifth differences also find the noise. Movement contributes much less to them, unless it has few samples.
    pub white: bool,
}

impl VelocityNoise {
    /// Shares above which noise counts: in general, and if it is white.
    const COUNTS: f64 = 1e-3;
    const COUNTS_IF_WHITE: f64 = 1e-6;

    /// Whether velocities count as exact: noise makes up less than a thousandth of their squares, or less than a millionth if it is white.
    pub fn is_negligible(&self) -> bool {
        self.share <= if self.white { Self::COUNTS_IF_WHITE } else { Self::COUNTS }
    }

    /// Estimates the noise by third differences of the velocities, as [`PositionNoise::of`] does for positions. `None` if a movement has no
    /// velocities, or if they are too few, constant or too large for an estimate.
    pub fn of(demonstrations: &Demonstrations) -> Option<Self> {
        if demonstrations.trajectories().iter().any(|trajectory| trajectory.velocities().is_none()) {
            return None;
        }
        let series: fn(&Trajectory) -> &DMatrix<f64> = |of| of.velocities().unwrap_or(of.states());
        let noise = PositionNoise::of_series(demonstrations, series).ok()?;
        let by_fifth = deviations::<6>(demonstrations, &series).ok();
        let each = demonstrations.trajectories().iter().filter_map(Trajectory::velocities);
        let (power, count) = each.fold((0.0, 0), |(power, count), u| (power + u.norm_squared(), count + u.ncols()));
        let variance = noise.deviations.norm_squared();
        let white = by_fifth.is_some_and(|deviations| deviations.norm_squared() >= WHITE * variance);
        Some(VelocityNoise { variance, share: variance / (power / count as f64), white })
    }
}

/// Standard deviation of the noise in each dimension, (n), from differences of N samples, of order N − 1.
fn deviations<const N: usize>(
    demonstrations: &Demonstrations,
    series: &impl Fn(&Trajectory) -> &DMatrix<f64>,
) -> Result<DVector<f64>, SmoothingError> {
    let trajectories = demonstrations.trajectories();
    let found = trajectories.iter().map(|trajectory| (trajectory.n_samples() + 1).saturating_sub(N)).sum();
    if found < NEEDED {
        return Err(SmoothingError::TooFewDifferences { found, needed: NEEDED });
    }
    let dim = demonstrations.dim();
    Ok(DVector::from_fn(dim, |axis, _| {
        let mut all = Vec::with_capacity(found);
        for trajectory in trajectories {
            all.extend(differences::<N>(series(trajectory).as_slice(), dim, axis, trajectory.times()));
        }
        MEDIAN_TO_DEVIATION * median(all).unwrap_or(0.0) / squares::<N>().sqrt()
    }))
}

/// Absolute differences of N samples, of order N − 1, for one axis: for N = 4 |x_{i+3} − 3x_{i+2} + 3x_{i+1} − x_i|; `rows` holds x_ij at
/// `i * dim + j`. The factors are those of divided differences, which vanish for polynomials of lower order.
pub(crate) fn differences<'a, const N: usize>(
    rows: &'a [f64],
    dim: usize,
    axis: usize,
    times: Option<&'a [f64]>,
) -> impl Iterator<Item = f64> + 'a {
    let even = divided_difference(std::array::from_fn::<f64, N, _>(|k| k as f64));
    let x = move |i: usize| rows[i * dim + axis];
    let windows = (rows.len() / dim + 1).saturating_sub(N);
    (0..windows).map(move |first| {
        let factors = times.map_or(even, |times| divided_difference(std::array::from_fn(|k| times[first + k])));
        // Differences are taken first, so that a common offset of the samples causes no rounding errors.
        (1..N).map(|k| factors[k] * (x(first + k) - x(first))).sum::<f64>().abs()
    })
}

/// Factors c_k ∝ 1/Π_{j ≠ k}(t_k − t_j), with the same Σ c_k² as for even stamps.
fn divided_difference<const N: usize>(times: [f64; N]) -> [f64; N] {
    let span = times[N - 1] - times[0];
    let product = |k: usize| (0..N).filter(|&j| j != k).map(|j| (times[k] - times[j]) / span).product::<f64>();
    let factors: [f64; N] = std::array::from_fn(|k| 1.0 / product(k));
    let norm = (factors.iter().map(|factor| factor * factor).sum::<f64>() / squares::<N>()).sqrt();
    factors.map(|factor| factor / norm)
}

/// Sum of the squared factors for N even samples: 20 for N = 4.
fn squares<const N: usize>() -> f64 {
    let binomial = |k: usize| (1..=k).map(|i| (N - i) as f64 / i as f64).product::<f64>();
    (0..N).map(|k| binomial(k).powi(2)).sum()
}
