use nalgebra::DMatrix;

use crate::{MotionError, Trajectory};

/// K observed movements of one system, all with the same state dimension; lengths may differ.
///
/// They hold no constraint, so that a learner given `Demonstrations` cannot know it.
#[derive(Debug, Clone, PartialEq)]
pub struct Demonstrations {
    trajectories: Vec<Trajectory>,
}

impl Demonstrations {
    /// Movements of one system.
    ///
    /// # Errors
    /// [`MotionError::Empty`] or [`MotionError::Dimensions`].
    pub fn new(trajectories: Vec<Trajectory>) -> Result<Self, MotionError> {
        let expected = trajectories.first().ok_or(MotionError::Empty)?.dim();
        match trajectories.iter().position(|trajectory| trajectory.dim() != expected) {
            None => Ok(Demonstrations { trajectories }),
            Some(trajectory) => {
                Err(MotionError::Dimensions { trajectory, found: trajectories[trajectory].dim(), expected })
            }
        }
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

    /// Number of movements K.
    pub fn n_trajectories(&self) -> usize {
        self.trajectories.len()
    }

    /// Dimension n of the state.
    pub fn dim(&self) -> usize {
        self.trajectories[0].dim()
    }

    /// Coordinate `axis` of every sample, movement after movement.
    pub fn values(&self, axis: usize) -> impl Iterator<Item = f64> + Clone {
        self.trajectories.iter().flat_map(move |movement| movement.states().column_iter().map(move |x| x[axis]))
    }

    /// Number of samples of all movements together, M = Σ_k N_k.
    pub fn n_samples(&self) -> usize {
        self.trajectories.iter().map(Trajectory::n_samples).sum()
    }
}
