use nalgebra::{DMatrix, DVectorView};

use crate::{MotionError, Series};

/// One observed movement: states x₁..x_N at a fixed time step, and the velocities u₁..u_N where they were recorded.
///
/// A checked value: at least two samples, at least one dimension, every number finite.
#[derive(Debug, Clone, PartialEq)]
pub struct Trajectory {
    states: DMatrix<f64>,
    velocities: Option<DMatrix<f64>>,
    time_step: f64,
}

impl Trajectory {
    /// A movement of which only the states are known: `states` (n, N), one column a sample, `time_step` seconds
    /// apart.
    ///
    /// # Errors
    /// [`MotionError::TimeStep`], [`MotionError::NoDimension`], [`MotionError::TooShort`] or
    /// [`MotionError::NotFinite`].
    pub fn new(states: DMatrix<f64>, time_step: f64) -> Result<Self, MotionError> {
        if !(time_step.is_finite() && time_step > 0.0) {
            return Err(MotionError::TimeStep { time_step });
        }
        if states.nrows() == 0 {
            return Err(MotionError::NoDimension);
        }
        if states.ncols() < 2 {
            return Err(MotionError::TooShort { samples: states.ncols() });
        }
        require_finite(&states, Series::States)?;
        Ok(Trajectory { states, velocities: None, time_step })
    }

    /// The same movement with its recorded velocities or commands (n, N), in units of the state per second.
    ///
    /// # Errors
    /// [`MotionError::VelocityShape`] or [`MotionError::NotFinite`].
    pub fn with_velocities(self, velocities: DMatrix<f64>) -> Result<Self, MotionError> {
        if velocities.shape() != self.states.shape() {
            return Err(MotionError::VelocityShape { states: self.states.shape(), velocities: velocities.shape() });
        }
        require_finite(&velocities, Series::Velocities)?;
        Ok(Trajectory { velocities: Some(velocities), ..self })
    }

    /// The states, (n, N).
    pub fn states(&self) -> &DMatrix<f64> {
        &self.states
    }

    /// The recorded velocities, (n, N), in units of the state per second.
    pub fn velocities(&self) -> Option<&DMatrix<f64>> {
        self.velocities.as_ref()
    }

    /// Velocities of the steps, (x_{i+1} − x_i) / δt, (n, N − 1), in units of the state per second.
    pub fn step_velocities(&self) -> DMatrix<f64> {
        let steps = self.n_samples() - 1;
        (self.states.columns(1, steps) - self.states.columns(0, steps)) / self.time_step
    }

    /// Seconds between two samples.
    pub fn time_step(&self) -> f64 {
        self.time_step
    }

    /// State x_i, (n).
    pub fn state(&self, sample: usize) -> DVectorView<'_, f64> {
        self.states.column(sample)
    }

    /// Dimension n of the state.
    pub fn dim(&self) -> usize {
        self.states.nrows()
    }

    /// Number of samples N.
    pub fn n_samples(&self) -> usize {
        self.states.ncols()
    }
}

fn require_finite(values: &DMatrix<f64>, series: Series) -> Result<(), MotionError> {
    match values.iter().position(|value| !value.is_finite()) {
        None => Ok(()),
        Some(at) => Err(MotionError::NotFinite {
            series,
            sample: at / values.nrows(),
            dimension: at % values.nrows(),
            value: values[at],
        }),
    }
}
