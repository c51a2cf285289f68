use motion::{Demonstrations, MotionError, Trajectory};
use nalgebra::DMatrix;

use crate::SmoothingError;

/// A movement with a time stamp for every sample, evenly spaced or not.
///
/// A checked value: everything a [`Trajectory`] promises, and stamps that ascend.
#[derive(Debug, Clone, PartialEq)]
pub struct Stamped {
    trajectory: Trajectory,
}

impl Stamped {
    /// A movement through `states` (n, N), one column a sample, at `times` (N) in seconds.
    ///
    /// # Errors
    /// [`SmoothingError::Motion`].
    pub fn new(times: Vec<f64>, states: DMatrix<f64>) -> Result<Self, SmoothingError> {
        // Any time step will do: the stamps tell.
        Ok(Stamped { trajectory: Trajectory::new(states, 1.0)?.with_times(times)? })
    }

    /// The same movement with its recorded velocities (n, N), in units of the state per second.
    ///
    /// # Errors
    /// [`SmoothingError::Motion`].
    pub fn with_velocities(self, velocities: DMatrix<f64>) -> Result<Self, SmoothingError> {
        Ok(Stamped { trajectory: self.trajectory.with_velocities(velocities)? })
    }

    /// All movements of `demonstrations`.
    pub(crate) fn all(demonstrations: &Demonstrations) -> Vec<Stamped> {
        demonstrations.trajectories().iter().map(Stamped::from).collect()
    }

    /// The states, (n, N).
    pub fn states(&self) -> &DMatrix<f64> {
        self.trajectory.states()
    }

    /// The recorded velocities, (n, N), in units of the state per second.
    pub fn velocities(&self) -> Option<&DMatrix<f64>> {
        self.trajectory.velocities()
    }

    /// Number of samples N.
    pub fn n_samples(&self) -> usize {
        self.trajectory.n_samples()
    }

    /// Seconds from sample `from` to sample `to`.
    pub fn seconds(&self, from: usize, to: usize) -> f64 {
        self.trajectory.seconds(from, to)
    }

    /// The time stamps (N) in seconds; none if the samples are evenly spaced.
    pub(crate) fn times(&self) -> Option<&[f64]> {
        self.trajectory.times()
    }
}

impl From<&Trajectory> for Stamped {
    fn from(trajectory: &Trajectory) -> Self {
        Stamped { trajectory: trajectory.clone() }
    }
}

/// The dimension that all movements share.
pub(crate) fn common_dim(movements: &[Stamped]) -> Result<usize, SmoothingError> {
    let expected = movements.first().ok_or(MotionError::Empty)?.states().nrows();
    match movements.iter().position(|movement| movement.states().nrows() != expected) {
        None => Ok(expected),
        Some(trajectory) => {
            let found = movements[trajectory].states().nrows();
            Err(MotionError::Dimensions { trajectory, found, expected }.into())
        }
    }
}
