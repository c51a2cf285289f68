use gp::TaskSpace;
use kinematics::{LinkId, RobotModel};
use nalgebra::DMatrix;

use super::constraint_stretch::ConstraintOn;
use crate::channel_joints::ChannelJoints;
use crate::roll_out::link_point::LinkPoint;

/// Largest number of links examined if none is named.
const MOST_LINKS: usize = 6;

/// Links of a robot whose positions or orientations may be constrained. Channels of the state are joints of the same name.
#[derive(Debug, Clone)]
pub struct TaskLinks {
    /// The links with their names.
    links: Vec<(String, LinkPoint)>,
}

impl TaskLinks {
    /// Reads a robot from the text of a URDF. Uses the named links or, if none is named, the last links of all chains that
    /// the channels move.
    ///
    /// # Errors
    /// A sentence that describes a fault of the text, a link or a channel, or that there are too many last links.
    pub fn from_urdf(text: &str, links: &[String], channels: &[String]) -> Result<Self, String> {
        let robot = RobotModel::from_urdf(text).map_err(|error| error.to_string())?;
        let named = if links.is_empty() { last_links(&robot) } else { links.to_vec() };
        if named.is_empty() || links.is_empty() && named.len() > MOST_LINKS {
            return Err(format!(
                "the robot has {} links at ends of its chains; name those that touch something",
                named.len()
            ));
        }
        let link = |name: String| Ok((name.clone(), LinkPoint::new(&robot, &name, channels)?));
        Ok(TaskLinks { links: named.into_iter().map(link).collect::<Result<_, String>>()? })
    }

    /// The last links of a robot's chains that the channels alone move; none if there are too many to try them all.
    ///
    /// # Errors
    /// A sentence that names the channel that is not a joint.
    pub(crate) fn moved_by(robot: &RobotModel, channels: &[String]) -> Result<Self, String> {
        ChannelJoints::of(robot, channels.iter().map(String::as_str))?;
        let link = |name: String| Some((name.clone(), LinkPoint::new(robot, &name, channels).ok()?));
        let links: Vec<_> = last_links(robot).into_iter().filter_map(link).collect();
        Ok(TaskLinks { links: if links.len() > MOST_LINKS { Vec::new() } else { links } })
    }

    /// Position, orientation and both of every link as task spaces, for states (n) in columns, with their names.
    pub(crate) fn poses(&self, states: &DMatrix<f64>) -> Result<Vec<(String, TaskSpace)>, String> {
        let mut spaces = Vec::new();
        for (name, link) in &self.links {
            let poses = link.jacobians(states)?;
            let [positions, orientations] = [0, 3].map(|first| rows_from(first, &poses));
            for (what, of) in [("position", positions), ("orientation", orientations), ("pose", poses)] {
                spaces.push((format!("{what} of {name}"), TaskSpace::of_jacobians(of)));
            }
        }
        Ok(spaces)
    }

    /// Position and orientation of every link as task spaces, for states (n) in columns.
    pub(super) fn spaces(&self, states: &DMatrix<f64>) -> Result<Vec<(ConstraintOn, TaskSpace)>, String> {
        let mut spaces = Vec::new();
        for (name, link) in &self.links {
            let poses = link.jacobians(states)?;
            let [positions, orientations] = [0, 3].map(|first| TaskSpace::of_jacobians(rows_from(first, &poses)));
            spaces.push((ConstraintOn::Position(name.clone()), positions));
            spaces.push((ConstraintOn::Orientation(name.clone()), orientations));
        }
        Ok(spaces)
    }

    /// Positions of a link, (3, N), in metres, at each of these states (n, N); `None` for an unknown link.
    pub(super) fn places(&self, link: &str, states: &DMatrix<f64>) -> Result<Option<DMatrix<f64>>, String> {
        let point = self.links.iter().find(|(name, _)| name == link);
        point.map(|(_, point)| point.places(states)).transpose()
    }
}

/// Three rows of each Jacobian (6, n), from row `first` on.
fn rows_from(first: usize, jacobians: &[DMatrix<f64>]) -> Vec<DMatrix<f64>> {
    jacobians.iter().map(|jacobian| jacobian.rows(first, 3).into_owned()).collect()
}

/// Links that move and carry no other.
fn last_links(robot: &RobotModel) -> Vec<String> {
    let carries = |link: &LinkId| robot.links().any(|other| robot.parent(other) == Some(*link));
    let moves = |link: &LinkId| {
        let above = std::iter::successors(Some(*link), |&link| robot.parent(link));
        above.filter_map(|link| robot.attachment(link)).any(|attachment| attachment.joint.is_some())
    };
    let last = robot.links().filter(|link| !carries(link) && moves(link));
    last.map(|link| robot.link_name(link).to_owned()).collect()
}
