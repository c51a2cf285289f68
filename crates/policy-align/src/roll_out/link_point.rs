use kinematics::{Chain, RobotModel, Workspace};
use nalgebra::{DMatrix, DVectorView, Matrix3xX, Matrix6xX, Point3};

use crate::channel_joints::ChannelJoints;

/// The origin of a robot's link as the state moves it. Channels of the state are joints of the same name.
#[derive(Debug, Clone)]
pub(crate) struct LinkPoint {
    chain: Chain,
    joints: ChannelJoints,
}

impl LinkPoint {
    /// # Errors
    /// In a sentence: a link that is not there, or a channel that is no joint, or a joint that moves the link and is no
    /// channel.
    pub(crate) fn new(robot: &RobotModel, link: &str, channels: &[String]) -> Result<Self, String> {
        let link = robot.link(link).map_err(|error| error.to_string())?;
        let joints = ChannelJoints::of(robot, channels.iter().map(String::as_str));
        let joints = joints.map_err(|error| error.to_string())?;
        let mut above = Some(link);
        while let Some(attachment) = above.and_then(|link| robot.attachment(link)) {
            let missing = attachment.joint.filter(|joint| !joints.places.contains(&joint.column));
            if let Some(joint) = missing {
                let name = robot.joints()[joint.column].name();
                return Err(format!("joint '{name}' moves the link and is no channel of the state"));
            }
            above = Some(attachment.parent);
        }
        Ok(LinkPoint { chain: robot.chain(link), joints })
    }

    /// Where the point is, metres in the root link's frame, and the derivative of that by the state, (3, n).
    ///
    /// # Errors
    /// What the robot says of the configuration.
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

    /// The derivative of the link's orientation by the state, (3, n): what velocities of the state make of its angular velocity,
    /// in the root link's axes.
    ///
    /// # Errors
    /// What the robot says of the configuration.
    pub(crate) fn turning(&self, state: DVectorView<'_, f64>) -> Result<DMatrix<f64>, String> {
        let q = self.joints.configuration(state);
        let mut jacobian = Matrix6xX::zeros(self.joints.n_joints());
        let pose = self.chain.jacobian(q.as_view(), &mut Workspace::new(), &mut jacobian);
        pose.map_err(|error| error.to_string())?;
        Ok(DMatrix::from_fn(3, self.joints.places.len(), |row, channel| {
            jacobian[(3 + row, self.joints.places[channel])]
        }))
    }
}
