use motion::Trajectory;
use nalgebra::{DMatrix, DVector};

use crate::piecewise::averages::Averages;

/// Movements without noise.
#[derive(Debug, Clone, PartialEq)]
pub struct Smoothed {
    /// In the order of the demonstrations.
    pub movements: Vec<SmoothedMovement>,
    /// Standard deviation of the noise of each dimension, (n), in its unit; 0 if a dimension never changes.
    pub noise: DVector<f64>,
    /// The noise variance s², in squared units of the scaled axes.
    pub noise_variance: f64,
}

/// One movement without noise.
#[derive(Debug, Clone, PartialEq)]
pub struct SmoothedMovement {
    /// States x̂, (n, N).
    pub states: DMatrix<f64>,
    /// Velocities û, (n, N), in units of the state per second.
    pub velocities: DMatrix<f64>,
    /// Variance of the states at each sample, (N), mean over the dimensions.
    pub state_variance: DVector<f64>,
    /// Variance s_i² of the velocities at each sample, (N), mean over the dimensions.
    pub velocity_variance: DVector<f64>,
    /// Probability that a constraint switched between the previous sample and this one, (N); 1 at sample 0.
    pub window_begins: DVector<f64>,
    /// Log marginal likelihood of the whole movement, f_N of (S16).
    pub log_evidence: f64,
}

impl SmoothedMovement {
    /// Converts scaled axes to the recorded ones; `scales` (n) has zeros for axes that never move.
    pub(crate) fn unscaled(
        averages: Averages,
        log_evidence: f64,
        scales: &DVector<f64>,
        recorded: &Trajectory,
    ) -> Self {
        let mut states = recorded.states().clone();
        let mut velocities = DMatrix::zeros(states.nrows(), states.ncols());
        let means = states.column_mean();
        let moving = (0..scales.len()).filter(|&axis| scales[axis] > 0.0);
        for (row, axis) in moving.enumerate() {
            for i in 0..states.ncols() {
                states[(axis, i)] = means[axis] + scales[axis] * averages.states.mean[(row, i)];
                velocities[(axis, i)] = scales[axis] * averages.velocities.mean[(row, i)];
            }
        }
        let mean_square = scales.norm_squared() / scales.len() as f64;
        SmoothedMovement {
            states,
            velocities,
            state_variance: averages.states.variance * mean_square,
            velocity_variance: averages.velocities.variance * mean_square,
            window_begins: averages.window_begins,
            log_evidence,
        }
    }
}
