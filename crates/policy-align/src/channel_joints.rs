use kinematics::{JointKind, KinematicsError, RobotModel};
use nalgebra::{DMatrix, DMatrixView, DVector, DVectorView};
use prepare::StateChannel;

/// Configurations that are placed at once; their links fit into the processor's cache.
const AT_ONCE: usize = 64;

/// The joints of a robot that the channels of a state are.
#[derive(Debug, Clone)]
pub(crate) struct ChannelJoints {
    n_joints: usize,
    /// For each channel, its joint's place in a configuration.
    pub(crate) places: Vec<usize>,
}

impl ChannelJoints {
    /// By name.
    ///
    /// # Errors
    /// [`KinematicsError::UnknownJoint`] for a channel that is no joint.
    pub(crate) fn of<'a>(robot: &RobotModel, channels: impl Iterator<Item = &'a str>) -> Result<Self, KinematicsError> {
        let places = channels.map(|channel| robot.joint(channel)).collect::<Result<_, _>>()?;
        Ok(ChannelJoints { n_joints: robot.n_joints(), places })
    }

    /// One channel for each joint, in the order of a configuration.
    pub(crate) fn in_order(robot: &RobotModel) -> Self {
        ChannelJoints { n_joints: robot.n_joints(), places: (0..robot.n_joints()).collect() }
    }

    /// Number of the robot's joints.
    pub(crate) fn n_joints(&self) -> usize {
        self.n_joints
    }

    /// The configuration in a state (n) in radians and metres; joints that are no channels are at 0.
    pub(crate) fn configuration(&self, state: DVectorView<'_, f64>) -> DVector<f64> {
        let mut q = DVector::zeros(self.n_joints);
        for (&place, &x) in self.places.iter().zip(state.iter()) {
            q[place] = x;
        }
        q
    }

    /// [`ChannelJoints::configuration`] of each of these states (n, N), and likewise of velocities.
    pub(crate) fn configurations(&self, states: DMatrixView<'_, f64>) -> DMatrix<f64> {
        let mut q = DMatrix::zeros(self.n_joints, states.ncols());
        for (&place, row) in self.places.iter().zip(states.row_iter()) {
            q.row_mut(place).copy_from(&row);
        }
        q
    }

    /// Hands over the configurations of these states (n, N) by groups that are placed at once, each with the number of its first state.
    ///
    /// # Errors
    /// What `each` answers, [`KinematicsError::InBatch`] with the number of the state among all.
    pub(crate) fn by_groups(
        &self,
        states: &DMatrix<f64>,
        mut each: impl FnMut(usize, DMatrix<f64>) -> Result<(), KinematicsError>,
    ) -> Result<(), KinematicsError> {
        (0..states.ncols()).step_by(AT_ONCE).try_for_each(|first| {
            let group = states.columns(first, AT_ONCE.min(states.ncols() - first));
            each(first, self.configurations(group)).map_err(|error| match error {
                KinematicsError::InBatch { index, reason } => KinematicsError::InBatch { index: first + index, reason },
                error => error,
            })
        })
    }
}

/// What divides the numbers that are learnt from, of channels that are joints, into radians and metres, (n).
pub(crate) fn scales_of_joints(state: &[StateChannel]) -> DVector<f64> {
    let scale = |channel: &StateChannel| channel.scale / unit(channel.unit.as_deref(), None);
    DVector::from_iterator(state.len(), state.iter().map(scale))
}

/// States (n, N) over factors (n).
pub(crate) fn unscaled(states: &DMatrix<f64>, scales: &DVector<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(states.nrows(), states.ncols(), |row, column| states[(row, column)] / scales[row])
}

/// Radians or metres in a unit of a channel that is a joint; its numbers as they are where nothing is known of it. Of no kind: whatever its
/// unit says.
pub(crate) fn unit(unit: Option<&str>, joint: Option<JointKind>) -> f64 {
    match (unit, joint) {
        (Some("mm"), None | Some(JointKind::Prismatic)) => 1e-3,
        (Some("cm"), None | Some(JointKind::Prismatic)) => 1e-2,
        (_, Some(JointKind::Prismatic)) => 1.0,
        (Some("deg" | "degree" | "degrees" | "°"), _) => 1f64.to_radians(),
        _ => 1.0,
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::dvector;

    use super::*;

    #[test]
    fn numbers_become_radians_and_metres() {
        let channel = |(unit, scale): (&str, f64)| StateChannel {
            name: String::new(),
            unit: Some(unit.to_owned()),
            scale,
            low: 0.0,
            high: 1.0,
            median: 0.5,
        };
        let state = [("rad", 1.0), ("deg", 2.0), ("mm", 0.5), ("m", 4.0)].map(channel);
        // What is learnt from is the recorded number times the scale.
        let learnt = dvector![1.5, 2.0 * 90.0, 0.5 * 250.0, 4.0 * 0.25];
        let converted = learnt.component_div(&scales_of_joints(&state));
        assert!((converted - dvector![1.5, std::f64::consts::FRAC_PI_2, 0.25, 0.25]).amax() < 1e-12);
    }
}
