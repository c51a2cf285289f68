use kinematics::{Chain, RobotModel, Workspace};
use nalgebra::{DMatrix, DVectorView, Matrix3xX, Matrix6xX, Point3};

use crate::channel_joints::ChannelJoints;

/// The origin of a robot's link as a function of the state. Channels of the state are joints of the same name.
#[derive(Debug, Clone)]
pub(crate) struct LinkPoint {
    chain: Chain,
    joints: ChannelJoints,
}

impl LinkPoint {
    /// # Errors
    /// A sentence: an unknown link, a channel that is not a joint, or a joint that moves the link and is not a channel.
    pub(crate) fn new(robot: &RobotModel, link: &str, channels: &[String]) -> Result<Self, String> {
        let link = robot.link(link).map_err(|error| error.to_string())?;
        let joints = ChannelJoints::of(robot, channels.iter().map(String::as_str))?;
        let mut above = Some(link);
        while let Some(attachment) = above.and_then(|link| robot.attachment(link)) {
            let missing = attachment.joint.filter(|joint| !joints.places.contains(&joint.column));
            if let Some(joint) = missing {
                let name = robot.joints()[joint.column].name();
                return Err(format!("joint '{name}' moves the link but is not a channel of the state"));
            }
            above = Some(attachment.parent);
        }
        Ok(LinkPoint { chain: robot.chain(link), joints })
    }

    /// Position of the point, metres in the root link's frame, and its derivative with respect to the state, (3, n).
    ///
    /// # Errors
    /// The robot model's error for the configuration.
    pub(crate) fn at(&self, state: DVectorView<'_, f64>) -> Result<(Point3<f64>, DMatrix<f64>), String> {
        let q = self.joints.configuration(state);
        let mut jacobian = Matrix3xX::zeros(self.joints.n_joints());
        let origin = self.chain.position_jacobian(q.as_view(), &mut Workspace::new(), &mut jacobian);
        let origin = origin.map_err(|error| error.to_string())?;
        Ok((
            origin,
            DMatrix::from_fn(3, self.joints.places.len(), |row, channel| jacobian[(row, self.joints.places[channel])]),
        ))
    }

    /// Positions of the point at each of these states (n, N), (3, N), metres in the root link's frame.
    ///
    /// # Errors
    /// The robot model's error for the first configuration that it refuses.
    pub(crate) fn places(&self, states: &DMatrix<f64>) -> Result<DMatrix<f64>, String> {
        let (mut places, mut workspace) = (DMatrix::zeros(3, states.ncols()), Workspace::new());
        let placed = self.joints.by_groups(states, |first, q| {
            for (index, pose) in self.chain.poses(q.as_view(), &mut workspace)?.iter().enumerate() {
                places.set_column(first + index, &pose.translation.vector);
            }
            Ok(())
        });
        placed.map(|()| places).map_err(|error| error.to_string())
    }

    /// Jacobians (6, n) of the link's pose at each of these states (n, N). They map velocities of the state to the velocity vx vy vz of
    /// the link's origin and the angular velocity wx wy wz, in the root link's axes.
    ///
    /// # Errors
    /// The robot model's error for the first configuration that it refuses.
    pub(crate) fn jacobians(&self, states: &DMatrix<f64>) -> Result<Vec<DMatrix<f64>>, String> {
        let (n, places) = (self.joints.n_joints(), &self.joints.places);
        let (mut all, mut workspace) = (Vec::with_capacity(states.ncols()), Workspace::new());
        let placed = self.joints.by_groups(states, |_, q| {
            let mut jacobians = Matrix6xX::zeros(n * q.ncols());
            self.chain.jacobians(q.as_view(), &mut workspace, &mut jacobians)?;
            let of_channels = |index: usize| {
                DMatrix::from_fn(6, places.len(), |row, channel| jacobians[(row, index * n + places[channel])])
            };
            all.extend((0..q.ncols()).map(of_channels));
            Ok(())
        });
        placed.map(|()| all).map_err(|error| error.to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ARM: &str = include_str!("../../../../robots/seven_joint_arm.urdf");

    /// The tool link, and states whose channels are in another order than the joints.
    fn tool() -> (LinkPoint, DMatrix<f64>) {
        let robot = RobotModel::from_urdf(ARM).expect("the robot of this project loads");
        let names: Vec<String> = robot.joints().iter().rev().map(|joint| joint.name().to_owned()).collect();
        let point = LinkPoint::new(&robot, "tool", &names).expect("the tool is moved by all joints");
        (point, DMatrix::from_fn(names.len(), 150, |joint, index| ((5 * joint + 3 * index) as f64).sin()))
    }

    #[test]
    fn batch_results_equal_single_ones() {
        let (point, states) = tool();
        let places = point.places(&states).expect("all states are finite");
        let jacobians = point.jacobians(&states).expect("all states are finite");
        assert_eq!(jacobians.len(), states.ncols());
        for (index, state) in states.column_iter().enumerate() {
            let (place, derivative) = point.at(state).expect("all states are finite");
            assert_eq!(places.column(index), place.coords);
            assert_eq!(jacobians[index].rows(0, 3), derivative);
        }
    }

    #[test]
    fn the_first_state_at_fault_is_named() {
        let (point, mut states) = tool();
        states[(0, 109)] = f64::NAN;
        let wrong = point.jacobians(&states).expect_err("a state is not finite");
        assert!(wrong.starts_with("configuration 109: joint \""), "{wrong}");
        assert_eq!(point.places(&states).expect_err("a state is not finite"), wrong);
    }
}
