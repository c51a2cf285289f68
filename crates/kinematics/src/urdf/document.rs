use roxmltree::Node;

use super::{
    Element, UrdfCollision, UrdfInertial, UrdfJoint, UrdfProblem, UrdfWarning, geometry, inertial, joint, lenient,
    tag::{children, name_of},
    version::Version,
};
use crate::KinematicsError;

/// The kinematics of a URDF, in document order. Every number is finite; names are not looked up yet.
#[derive(Debug, Clone)]
pub(crate) struct UrdfRobot {
    pub(crate) name: String,
    pub(crate) links: Vec<String>,
    pub(crate) joints: Vec<UrdfJoint>,
    /// Kinematics does not need collision shapes, so a fault here is reported only when they are requested.
    pub(crate) collisions: Result<Vec<UrdfCollision>, KinematicsError>,
    /// A fault here is reported only when inertia is requested.
    pub(crate) inertials: Result<Vec<UrdfInertial>, KinematicsError>,
    pub(crate) warnings: Vec<UrdfWarning>,
}

/// Reads the tags of kinematics and collision and ignores all others.
pub(crate) fn read(text: &str) -> Result<UrdfRobot, KinematicsError> {
    parsed(text, read_robot)
}

/// The result of `read` for the outermost tag of a text, which must be `<robot>`.
pub(crate) fn parsed<T>(
    text: &str,
    read: impl FnOnce(Node<'_, '_>) -> Result<T, KinematicsError>,
) -> Result<T, KinematicsError> {
    let text = lenient::well_formed(text).map_err(|problem| KinematicsError::urdf(Element::Robot, problem))?;
    let document = lenient::strict(&text).map_err(|fault| KinematicsError::NotXml {
        line: fault.pos().row,
        column: fault.pos().col,
        message: fault.to_string(),
    })?;
    let robot = document.root_element();
    if robot.tag_name().name() != "robot" {
        let found = robot.tag_name().name().to_owned();
        return Err(KinematicsError::urdf(Element::Robot, UrdfProblem::RootTag { found }));
    }
    read(robot)
}

fn read_robot(robot: Node<'_, '_>) -> Result<UrdfRobot, KinematicsError> {
    let version = Version::of(robot.attribute("version"))?;
    let links: Vec<String> = children(robot, "link")
        .enumerate()
        .map(|(index, link)| name_of(link, || Element::UnnamedLink(index), "link.name"))
        .collect::<Result<_, _>>()?;
    if links.is_empty() {
        return Err(KinematicsError::urdf(Element::Robot, UrdfProblem::NoLinks));
    }
    let mut warnings = Vec::new();
    let joints = children(robot, "joint")
        .enumerate()
        .map(|(index, node)| joint::read(node, index, version, &mut warnings))
        .collect::<Result<_, _>>()?;
    let collisions = children(robot, "link")
        .enumerate()
        .map(|(index, node)| geometry::read(node, index, &links[index], version, &mut warnings))
        .collect::<Result<Vec<_>, _>>()
        .map(|links| links.concat());
    let inertials = children(robot, "link")
        .enumerate()
        .filter_map(|(index, node)| inertial::read(node, index, &links[index], version, &mut warnings).transpose())
        .collect();
    let name = robot.attribute("name").unwrap_or_default().to_owned();
    Ok(UrdfRobot { name, links, joints, collisions, inertials, warnings })
}
