use kinematics::RobotModel;
use nalgebra::DVectorView;

use crate::channel_joints::joint_of;

/// Limits of those channels that are joints of a robot.
#[derive(Debug, Clone, PartialEq)]
pub struct JointLimits {
    /// Channel, joint, lower and upper limit.
    limits: Vec<(usize, String, f64, f64)>,
}

impl JointLimits {
    /// The limits of a robot (the text of its URDF) for the channels with the names of its joints, in radians or metres.
    ///
    /// # Errors
    /// A sentence that describes a fault of the text, or says that no channel is a joint.
    pub fn from_urdf(text: &str, channels: &[String]) -> Result<Self, String> {
        let robot = RobotModel::from_urdf(text).map_err(|error| error.to_string())?;
        let limit_of = |(at, name): (usize, &String)| {
            let joint = &robot.joints()[joint_of(&robot, name)?];
            Some((at, name.clone(), joint.lower(), joint.upper()))
        };
        let limits: Vec<_> = channels.iter().enumerate().filter_map(limit_of).collect();
        if limits.is_empty() {
            let joints: Vec<_> = robot.joints().iter().map(kinematics::Joint::name).collect();
            return Err(format!("no channel of the state is a joint of this robot, which has {}", joints.join(", ")));
        }
        Ok(JointLimits { limits })
    }

    /// The first joint that is beyond its limits at a state.
    pub fn beyond(&self, state: DVectorView<'_, f64>) -> Option<&str> {
        let (_, name, ..) =
            self.limits.iter().find(|(at, _, lower, upper)| !(*lower..=*upper).contains(&state[*at]))?;
        Some(name)
    }
}
