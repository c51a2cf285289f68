use nalgebra::DMatrix;

use crate::{MotionError, Trajectory, upper_median};

/// K observed movements of one system, all with the same dimensions of state and context; lengths may differ.
///
/// They contain no constraints, so that a learner cannot use them.
#[derive(Debug, Clone, PartialEq)]
pub struct Demonstrations {
    trajectories: Vec<Trajectory>,
}

impl Demonstrations {
    /// Movements of one system.
    ///
    /// # Errors
    /// [`MotionError::Empty`], [`MotionError::Dimensions`] or [`MotionError::ContextDimensions`].
    pub fn new(trajectories: Vec<Trajectory>) -> Result<Self, MotionError> {
        let first = trajectories.first().ok_or(MotionError::Empty)?;
        let (dim, context_dim) = (first.dim(), first.context().len());
        if let Some(trajectory) = trajectories.iter().position(|trajectory| trajectory.dim() != dim) {
            let found = trajectories[trajectory].dim();
            return Err(MotionError::Dimensions { trajectory, found, expected: dim });
        }
        if let Some(trajectory) = trajectories.iter().position(|of| of.context().len() != context_dim) {
            let found = trajectories[trajectory].context().len();
            return Err(MotionError::ContextDimensions { trajectory, found, expected: context_dim });
        }
        Ok(Demonstrations { trajectories })
    }

    /// Movements without recorded velocities: each matrix (n, N_k), one column a sample, all `time_step`
    /// seconds apart.
    ///
    /// # Errors
    /// [`MotionError::InTrajectory`] with the trajectory at fault, otherwise as [`Demonstrations::new`].
    pub fn from_states(states: impl IntoIterator<Item = DMatrix<f64>>, time_step: f64) -> Result<Self, MotionError> {
        let trajectories = states.into_iter().enumerate().map(|(trajectory, states)| {
            Trajectory::new(states, time_step)
                .map_err(|source| MotionError::InTrajectory { trajectory, source: Box::new(source) })
        });
        Self::new(trajectories.collect::<Result<_, _>>()?)
    }

    /// The movements, in the order given.
    pub fn trajectories(&self) -> &[Trajectory] {
        &self.trajectories
    }

    /// The movements, in the order given.
    pub fn into_trajectories(self) -> Vec<Trajectory> {
        self.trajectories
    }

    /// Number of movements K.
    pub fn n_trajectories(&self) -> usize {
        self.trajectories.len()
    }

    /// Dimension n of the state.
    pub fn dim(&self) -> usize {
        self.trajectories[0].dim()
    }

    /// Dimension p of the context; 0 without one.
    pub fn context_dim(&self) -> usize {
        self.trajectories[0].context().len()
    }

    /// Coordinate `axis` of every sample, movement after movement.
    pub fn values(&self, axis: usize) -> impl Iterator<Item = f64> + Clone {
        self.trajectories.iter().flat_map(move |movement| movement.states().column_iter().map(move |x| x[axis]))
    }

    /// Number of samples of all movements together, M = Σ_k N_k.
    pub fn n_samples(&self) -> usize {
        self.trajectories.iter().map(Trajectory::n_samples).sum()
    }

    /// The typical time step, in seconds: the median of the movements' steps, the upper of two.
    pub fn time_step(&self) -> f64 {
        upper_median(self.trajectories.iter().map(Trajectory::time_step).collect()).expect("there is a movement")
    }
}
