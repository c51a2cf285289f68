use demo_io::LinkFrames;
use kinematics::{Joint, LinkId, RobotModel, Workspace};
use motion::Channel;
use nalgebra::{DVector, DVectorView, Isometry3};

use crate::channel_joints::{ChannelJoints, joint_of, unit};

/// The frames of a robot's links along recordings or roll-outs, for [`demo_io::write_with_robot`].
///
/// Channels are joints of the same name; joints without a channel stay at 0. If no channel has the name of a joint and their
/// numbers are equal, they are matched in order.
#[derive(Debug, Clone)]
pub struct RobotFrames {
    text: String,
    robot: RobotModel,
    joints: ChannelJoints,
    by_name: bool,
    /// The rows of a state that are joints.
    rows: Vec<usize>,
    /// Radians or metres per unit of each of them.
    units: DVector<f64>,
    /// All links but the root, and their parents.
    links: Vec<LinkId>,
    names: Vec<[String; 2]>,
}

impl RobotFrames {
    /// Reads a robot from the text of a URDF, and matches the channels of the recordings except `others`, which are not joints
    /// (a context). Degrees, centimetres and millimetres are converted.
    ///
    /// # Errors
    /// A sentence that describes a fault of the text, names a channel that is not a joint, or says that the numbers of channels
    /// and joints differ.
    pub fn from_urdf(text: &str, channels: &[Channel], others: &[String]) -> Result<Self, String> {
        let robot = RobotModel::from_urdf(text).map_err(|error| error.to_string())?;
        let rows: Vec<usize> = (0..channels.len()).filter(|&row| !others.contains(&channels[row].name)).collect();
        let channels: Vec<&Channel> = rows.iter().map(|&row| &channels[row]).collect();
        let names = || channels.iter().map(|channel| channel.name.as_str());
        let by_name = names().any(|name| joint_of(&robot, name).is_some());
        let joints = if by_name {
            ChannelJoints::of(&robot, names())?
        } else if channels.len() == robot.n_joints() {
            ChannelJoints::in_order(&robot)
        } else {
            let named = |names: Vec<&str>| format!("{} ({})", names.len(), names.join(", "));
            let of_robot = named(robot.joints().iter().map(Joint::name).collect());
            let of_state = named(names().collect());
            return Err(format!("the state has {of_state} channels and the robot {of_robot} joints, of other names"));
        };
        let unit =
            |(channel, &place): (&&Channel, &usize)| unit(channel.unit.as_deref(), Some(robot.joints()[place].kind()));
        let units = DVector::from_iterator(channels.len(), channels.iter().zip(&joints.places).map(unit));
        let links: Vec<LinkId> = robot.links().filter(|&link| link != robot.root()).collect();
        let name = |link: LinkId| robot.link_name(link).to_owned();
        let pair = |&link: &LinkId| Some([name(robot.parent(link)?), name(link)]);
        let names = links.iter().filter_map(pair).collect();
        Ok(RobotFrames { text: text.to_owned(), joints, by_name, rows, units, links, names, robot })
    }

    /// A description in one line of which joints the channels are.
    pub fn matching(&self) -> String {
        let RobotFrames { robot, joints, .. } = self;
        let name = |&place: &usize| robot.joints()[place].name();
        let channels: Vec<&str> = joints.places.iter().map(name).collect();
        if !self.by_name {
            return format!("{}: channels are its joints {} in this order", robot.name(), channels.join(", "));
        }
        let others: Vec<&str> =
            robot.joints().iter().map(Joint::name).filter(|name| !channels.contains(name)).collect();
        let rest = if others.is_empty() { String::new() } else { format!("; at 0: {}", others.join(", ")) };
        format!("{}: channels are joints by name{rest}", robot.name())
    }
}

impl LinkFrames for RobotFrames {
    fn description(&self) -> &str {
        &self.text
    }

    fn links(&self) -> &[[String; 2]] {
        &self.names
    }

    fn transforms(&self, state: DVectorView<'_, f64>) -> Result<Vec<Isometry3<f64>>, String> {
        let q = self.joints.configuration(state.select_rows(&self.rows).component_mul(&self.units).as_view());
        let mut workspace = Workspace::new();
        let poses = self.robot.forward_kinematics(q.as_view(), &mut workspace).map_err(|error| error.to_string())?;
        let transform = |&link: &LinkId| {
            let pose = poses.pose_in_parent(link)?;
            Some(Isometry3::from_parts(pose.translation, pose.rotation.into()))
        };
        Ok(self.links.iter().filter_map(transform).collect())
    }
}
