use constraints::NullSpaceProjector;
use motion::{Demonstrations, MotionError, Trajectory};
use nalgebra::{DMatrix, DVector};

use crate::DemoGenError;

/// One simulated movement: the observations and the truth.
#[derive(Debug, Clone, PartialEq)]
pub struct Recording {
    /// States and velocities as an observer records them, noise included.
    pub observed: Trajectory,
    /// The underlying truth. For judges only.
    pub truth: Truth,
}

/// Hidden quantities at each of the N samples of a movement, always free of noise.
#[derive(Debug, Clone, PartialEq)]
pub struct Truth {
    /// The states `x_i`, (n, N).
    pub states: DMatrix<f64>,
    /// The potential `φ(x_i)`, (N); empty if the policy has no potential.
    pub potential: DVector<f64>,
    /// The unconstrained policy `π(x_i) = −∇φ(x_i)`, (n, N), in units of the state per second.
    pub actions: DMatrix<f64>,
    /// The projectors `N(x_i, t_i)` (3) of the active constraints.
    pub projectors: Vec<NullSpaceProjector>,
}

/// The input of a learner: the observed part of the recordings, in their order.
///
/// # Errors
/// [`MotionError::Empty`] or [`MotionError::Dimensions`].
pub fn demonstrations(recordings: &[Recording]) -> Result<Demonstrations, MotionError> {
    Demonstrations::new(recordings.iter().map(|recording| recording.observed.clone()).collect())
}

/// K recordings, one after the other; errors name the trajectory.
pub(crate) fn record_each(
    n_trajectories: usize,
    mut record: impl FnMut() -> Result<Recording, DemoGenError>,
) -> Result<Vec<Recording>, DemoGenError> {
    if n_trajectories == 0 {
        return Err(DemoGenError::NoTrajectory);
    }
    let in_trajectory = |trajectory| move |source| DemoGenError::InTrajectory { trajectory, source: Box::new(source) };
    (0..n_trajectories).map(|trajectory| record().map_err(in_trajectory(trajectory))).collect()
}

/// Checks that starts can be drawn from [−`range`, `range`).
pub(crate) fn check_start_range(range: f64) -> Result<(), DemoGenError> {
    if range.is_finite() && range >= 0.0 { Ok(()) } else { Err(DemoGenError::StartRange { range }) }
}
