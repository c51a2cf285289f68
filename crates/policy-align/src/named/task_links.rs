use gp::TaskSpace;
use kinematics::{LinkId, RobotModel};
use nalgebra::{DMatrix, DVector, DVectorView};

use super::constraint_stretch::ConstraintOn;
use crate::roll_out::link_point::LinkPoint;

/// Links that are looked at if none is named, at most.
const MOST_LINKS: usize = 6;

/// Links of a robot whose positions or orientations constraints may keep. Channels of the state are joints of that name.
#[derive(Debug, Clone)]
pub struct TaskLinks {
    /// By name.
    links: Vec<(String, LinkPoint)>,
}

impl TaskLinks {
    /// Of the text of a URDF: the links named, or if none is, the last links of all chains that the channels move.
    ///
    /// # Errors
    /// In a sentence: what is wrong with the text, a link or a channel, or that there are too many last links.
    pub fn from_urdf(text: &str, links: &[String], channels: &[String]) -> Result<Self, String> {
        let robot = RobotModel::from_urdf(text).map_err(|error| error.to_string())?;
        let named = if links.is_empty() { last_links(&robot)? } else { links.to_vec() };
        let link = |name: String| Ok((name.clone(), LinkPoint::new(&robot, &name, channels)?));
        Ok(TaskLinks { links: named.into_iter().map(link).collect::<Result<_, String>>()? })
    }

    /// Position and orientation of every link as task spaces, for states (n) in columns.
    pub(super) fn spaces(&self, states: &DMatrix<f64>) -> Result<Vec<(ConstraintOn, TaskSpace)>, String> {
        let mut spaces = Vec::new();
        for (name, link) in &self.links {
            let position = |state: DVectorView<'_, f64>| Ok(link.at(state)?.1);
            spaces.push((ConstraintOn::Position(name.clone()), space(states, position)?));
            spaces.push((ConstraintOn::Orientation(name.clone()), space(states, |state| link.turning(state))?));
        }
        Ok(spaces)
    }

    /// Where a link is in each of these states (n, N), (3, N), in metres; none for one that is not among them.
    pub(super) fn places(&self, link: &str, states: &DMatrix<f64>) -> Result<Option<DMatrix<f64>>, String> {
        let Some((_, point)) = self.links.iter().find(|(name, _)| name == link) else { return Ok(None) };
        let place = |state: DVectorView<'_, f64>| Ok(DVector::from_column_slice(point.at(state)?.0.coords.as_slice()));
        let places = states.column_iter().map(place).collect::<Result<Vec<_>, String>>()?;
        Ok(Some(DMatrix::from_columns(&places)))
    }
}

fn space(
    states: &DMatrix<f64>,
    jacobian: impl Fn(DVectorView<'_, f64>) -> Result<DMatrix<f64>, String>,
) -> Result<TaskSpace, String> {
    let jacobians = states.column_iter().map(jacobian).collect::<Result<_, String>>()?;
    Ok(TaskSpace::of_jacobians(jacobians))
}

/// Links that move and carry no other.
fn last_links(robot: &RobotModel) -> Result<Vec<String>, String> {
    let carries = |link: &LinkId| robot.links().any(|other| robot.parent(other) == Some(*link));
    let moves = |link: &LinkId| {
        let above = std::iter::successors(Some(*link), |&link| robot.parent(link));
        above.filter_map(|link| robot.attachment(link)).any(|attachment| attachment.joint.is_some())
    };
    let last = robot.links().filter(|link| !carries(link) && moves(link));
    let names: Vec<String> = last.map(|link| robot.link_name(link).to_owned()).collect();
    if names.is_empty() || names.len() > MOST_LINKS {
        return Err(format!(
            "the robot has {} links at ends of its chains; name those that touch something",
            names.len()
        ));
    }
    Ok(names)
}
