use kinematics::RobotModel;

use crate::{DemoGenError, Recording};

/// Number of recorded movements that leave the joint limits of `robot` at any of their samples.
///
/// # Errors
/// [`DemoGenError::Robot`] if the recordings are not of this robot's configurations.
pub fn n_leaving_limits(robot: &RobotModel, recordings: &[Recording]) -> Result<usize, DemoGenError> {
    let mut n_leaving = 0;
    for recording in recordings {
        let mut beyond = 0;
        for q in recording.truth.states.column_iter() {
            beyond += robot.n_beyond_limits(q)?;
        }
        n_leaving += usize::from(beyond > 0);
    }
    Ok(n_leaving)
}
