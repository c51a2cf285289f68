//! Input of the smoother: axes scaled to equal noise, each movement centred on its mean.

use motion::{Demonstrations, Trajectory, standard_deviation};
use nalgebra::DVector;
use serde::Serialize;

use crate::SmoothingError;
use crate::error::require;

/// Divisor of each axis before smoothing.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub enum AxisScale {
    /// Its standard deviation over all samples.
    StandardDeviation,
    /// As given, (n), all positive: for sensors with known noise per axis.
    Given(DVector<f64>),
}

/// All movements in scaled axes, and their scales.
#[derive(Debug)]
pub(crate) struct Scaled<'a> {
    pub(crate) movements: Vec<ScaledMovement<'a>>,
    /// Divisor of each axis, (n); 0 if an axis never moves and is left out.
    pub(crate) scales: DVector<f64>,
    /// c of (S15): mean over the moving axes of the variance of all samples, in scaled axes.
    pub(crate) variance: f64,
}

/// One movement in the moving axes.
#[derive(Debug)]
pub(crate) struct ScaledMovement<'a> {
    pub(crate) recorded: &'a Trajectory,
    /// Number of moving axes d.
    pub(crate) dim: usize,
    /// y_ij at `i * dim + j`: scaled, minus the movement's mean.
    pub(crate) rows: Vec<f64>,
}

impl<'a> Scaled<'a> {
    pub(crate) fn new(demonstrations: &'a Demonstrations, scale: &AxisScale) -> Result<Self, SmoothingError> {
        let (movements, dim) = (demonstrations.trajectories(), demonstrations.dim());
        let variances = DVector::from_fn(dim, |axis, _| variance_of_axis(demonstrations, axis));
        if variances.iter().any(|variance| !variance.is_finite()) {
            return Err(SmoothingError::Overflow);
        }
        let scales = match scale {
            AxisScale::StandardDeviation => variances.map(f64::sqrt),
            AxisScale::Given(scales) => {
                check(scales, dim)?;
                DVector::from_fn(dim, |axis, _| if variances[axis] > 0.0 { scales[axis] } else { 0.0 })
            }
        };
        let moving: Vec<usize> = (0..dim).filter(|&axis| scales[axis] > 0.0).collect();
        if moving.is_empty() {
            return Err(SmoothingError::NoMotion);
        }
        let variance =
            moving.iter().map(|&j| variances[j] / (scales[j] * scales[j])).sum::<f64>() / moving.len() as f64;
        if !variance.is_finite() {
            return Err(SmoothingError::Overflow);
        }
        let movements = movements.iter().map(|recorded| ScaledMovement::new(recorded, &scales, &moving)).collect();
        Ok(Scaled { movements, scales, variance })
    }
}

impl<'a> ScaledMovement<'a> {
    fn new(recorded: &'a Trajectory, scales: &DVector<f64>, moving: &[usize]) -> Self {
        let means = recorded.states().column_mean();
        let rows = recorded
            .states()
            .column_iter()
            .flat_map(|state| moving.iter().map(move |&j| (state[j], j)))
            .map(|(x, j)| (x - means[j]) / scales[j])
            .collect();
        ScaledMovement { recorded, dim: moving.len(), rows }
    }

    pub(crate) fn n_samples(&self) -> usize {
        self.recorded.n_samples()
    }

    /// Rows of `samples` samples from sample `first` on.
    pub(crate) fn window(&self, first: usize, samples: usize) -> &[f64] {
        &self.rows[first * self.dim..][..samples * self.dim]
    }
}

fn check(scales: &DVector<f64>, dim: usize) -> Result<(), SmoothingError> {
    if scales.len() != dim {
        return Err(SmoothingError::AxisScales { found: scales.len(), expected: dim });
    }
    let positive =
        |&scale: &f64| require(scale.is_finite() && scale > 0.0, "axis_scale", scale, "be positive and finite");
    scales.iter().try_for_each(positive)
}

/// Variance of one coordinate over all samples of all movements.
fn variance_of_axis(demonstrations: &Demonstrations, axis: usize) -> f64 {
    standard_deviation(demonstrations.values(axis)).powi(2)
}
