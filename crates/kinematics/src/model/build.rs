use nalgebra::IsometryMatrix3;

use super::{
    CollisionShape, Inertial, Joint, LinkId, RobotModel,
    mimic::{self, is_active},
    tree::{self, Branch},
};
use crate::{
    JointKind, KinematicsError,
    nodes::{Coupling, Motion, Node, padded},
    urdf::{self, UrdfCollision, UrdfInertial, UrdfJoint, UrdfMotion, UrdfRobot},
};

impl RobotModel {
    /// Builds a robot from the text of a URDF, version 1.0, 1.1 or 1.2. Tags unrelated to kinematics are ignored, whatever
    /// their contents.
    ///
    /// # Errors
    /// [`KinematicsError::NotXml`], or [`KinematicsError::Urdf`] with the link or joint that breaks a rule.
    pub fn from_urdf(text: &str) -> Result<Self, KinematicsError> {
        Self::assemble(urdf::read(text)?)
    }

    fn assemble(urdf: UrdfRobot) -> Result<Self, KinematicsError> {
        let branches = tree::ordered(&urdf)?;
        let by_joint = mimic::couplings(&urdf.joints)?;
        let mut robot = RobotModel {
            links: branches.iter().map(|branch| urdf.links[branch.link].clone()).collect(),
            nodes: Vec::with_capacity(branches.len()),
            origins: Vec::with_capacity(branches.len()),
            couplings: Vec::new(),
            joints: urdf.joints.iter().filter_map(active).collect(),
            collision_shapes: urdf.collisions.map(|shapes| placed_shapes(shapes, &branches)),
            inertials: urdf.inertials.map(|inertials| placed_inertials(inertials, &branches)),
            name: urdf.name,
            warnings: urdf.warnings,
        };
        for branch in branches {
            match branch.joint {
                Some(joint) => robot.push(branch.parent, &urdf.joints[joint], by_joint[joint]),
                None => robot.push_node(
                    Node::new(0, None, Motion::Fixed, &IsometryMatrix3::identity()),
                    IsometryMatrix3::identity(),
                ),
            }
        }
        Ok(robot)
    }

    fn push(&mut self, parent: usize, joint: &UrdfJoint, coupling: Option<Coupling>) {
        let (motion, sign) = motion(&joint.motion);
        let index = coupling.map(|Coupling { column, multiplier, offset }| {
            self.couplings.push(Coupling { column, multiplier: sign * multiplier, offset: sign * offset });
            self.couplings.len() - 1
        });
        self.push_node(Node::new(parent, index, motion, &joint.origin), joint.origin);
    }

    fn push_node(&mut self, node: Node, origin: IsometryMatrix3<f64>) {
        self.nodes.push(node);
        self.origins.push(origin);
    }
}

/// Converts a robot read by the crate urdf-rs, version 0.10. The result is the one that [`RobotModel::from_urdf`] builds
/// from the same text, as far as urdf-rs keeps it. There are three differences: a `<limit>` of zeros alone counts as
/// missing, an infinite bound of URDF 1.2 counts as missing, and quaternions have become roll, pitch and yaw.
///
/// ```
/// use kinematics::RobotModel;
///
/// let read = urdf_rs::read_from_string(r#"<robot name="post"><link name="base"/></robot>"#)?;
/// assert_eq!(RobotModel::try_from(&read)?.name(), "post");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[cfg(feature = "urdf-rs")]
impl TryFrom<&urdf_rs::Robot> for RobotModel {
    /// [`KinematicsError::Urdf`] with the link or joint that breaks a rule.
    type Error = KinematicsError;

    fn try_from(robot: &urdf_rs::Robot) -> Result<Self, KinematicsError> {
        Self::assemble(urdf::from_urdf_rs(robot)?)
    }
}

/// The index in the tree of each link of the document.
fn places(branches: &[Branch]) -> Vec<LinkId> {
    let mut places = vec![LinkId(0); branches.len()];
    for (place, branch) in branches.iter().enumerate() {
        places[branch.link] = LinkId(place);
    }
    places
}

/// Inertia with its links in the order of the tree.
fn placed_inertials(inertials: Vec<UrdfInertial>, branches: &[Branch]) -> Vec<Inertial> {
    let places = places(branches);
    let placed = |UrdfInertial { link, origin, mass, tensor }| Inertial { link: places[link], origin, mass, tensor };
    inertials.into_iter().map(placed).collect()
}

/// Collision shapes with their links in the order of the tree.
fn placed_shapes(shapes: Vec<UrdfCollision>, branches: &[Branch]) -> Vec<CollisionShape> {
    let places = places(branches);
    let placed = |UrdfCollision { link, origin, geometry }| CollisionShape { link: places[link], origin, geometry };
    shapes.into_iter().map(placed).collect()
}

/// A joint's motion, and the sign by which its value is multiplied.
fn motion(motion: &UrdfMotion) -> (Motion, f64) {
    match motion {
        UrdfMotion::Fixed => (Motion::Fixed, 1.0),
        UrdfMotion::Moving { kind: JointKind::Prismatic, axis, .. } => (Motion::Translation(padded(axis)), 1.0),
        UrdfMotion::Moving { axis, .. } => Motion::rotation(*axis),
    }
}

fn active(joint: &UrdfJoint) -> Option<Joint> {
    match joint.motion {
        UrdfMotion::Moving { kind, lower, upper, .. } if is_active(joint) => {
            Some(Joint { name: joint.name.clone(), kind, lower, upper })
        }
        _ => None,
    }
}
