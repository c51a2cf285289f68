//! The robot: [`RobotModel`], built (`build`) from tags as a tree (`tree`) with resolved mimic joints (`mimic`); its
//! joints (`joint`) and their limits (`limits`); how a link is attached to its parent (`attachment`).

mod attachment;
mod build;
mod joint;
mod limits;
mod mimic;
mod tree;

use std::sync::Arc;

pub use attachment::{Attachment, JointMotion, MotionKind};
pub use joint::Joint;
pub(crate) use joint::{all_placeable, placeable};
use nalgebra::{IsometryMatrix3, Matrix3};

use crate::{
    Geometry, KinematicsError, UrdfWarning,
    names::near_names,
    nodes::{Coupling, Node},
};

/// A link of one robot; its frame is the frame of the joint that carries it, and moves with it. With another robot, it
/// denotes another link or causes a panic.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct LinkId(pub(crate) usize);

/// A robot: a tree of links and joints, checked and immutable.
///
/// Poses are in the root link's frame, in metres; angles in radians. Configurations q (n) and the columns of Jacobians
/// follow the active joints in document order; mimic joints have no coordinate, and their part of a Jacobian
/// is added to the column of the joint they follow.
#[derive(Debug, Clone)]
pub struct RobotModel {
    pub(crate) name: String,
    /// Names of the links, in the order of the nodes: a parent comes before its children, the root first.
    pub(crate) links: Arc<[String]>,
    pub(crate) nodes: Vec<Node>,
    /// Origins of the nodes' joints in their parents' frames.
    pub(crate) origins: Vec<IsometryMatrix3<f64>>,
    pub(crate) couplings: Vec<Coupling>,
    pub(crate) joints: Arc<[Joint]>,
    pub(crate) collision_shapes: Result<Vec<CollisionShape>, KinematicsError>,
    pub(crate) inertials: Result<Vec<Inertial>, KinematicsError>,
    pub(crate) warnings: Vec<UrdfWarning>,
}

/// A collision shape of a link.
#[derive(Debug, Clone, PartialEq)]
pub struct CollisionShape {
    /// The link.
    pub link: LinkId,
    /// The shape's pose in the link's frame, metres.
    pub origin: IsometryMatrix3<f64>,
    /// The shape in its own frame.
    pub geometry: Geometry,
}

/// Inertia of a link.
#[derive(Debug, Clone, PartialEq)]
pub struct Inertial {
    /// The link.
    pub link: LinkId,
    /// The centre of mass and the axes of `tensor`, in the link's frame, metres.
    pub origin: IsometryMatrix3<f64>,
    /// Mass in kilograms.
    pub mass: f64,
    /// Inertia tensor about the centre of mass, kg m².
    pub tensor: Matrix3<f64>,
}

impl RobotModel {
    /// The robot's name; empty if the file has none.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The active joints, in the order of a configuration's values.
    pub fn joints(&self) -> &[Joint] {
        &self.joints
    }

    /// Number n of active joints.
    pub fn n_joints(&self) -> usize {
        self.joints.len()
    }

    /// The index of an active joint in a configuration.
    ///
    /// # Errors
    /// [`KinematicsError::UnknownJoint`].
    pub fn joint(&self, name: &str) -> Result<usize, KinematicsError> {
        self.joints.iter().position(|joint| joint.name == name).ok_or_else(|| KinematicsError::UnknownJoint {
            name: name.to_owned(),
            near: near_names(name, self.joints.iter().map(Joint::name)),
        })
    }

    /// All links, the root first and every link after its parent.
    pub fn links(&self) -> impl ExactSizeIterator<Item = LinkId> + use<> {
        (0..self.links.len()).map(LinkId)
    }

    /// The root link; all poses are in its frame.
    pub fn root(&self) -> LinkId {
        LinkId(0)
    }

    /// The link of this name.
    ///
    /// # Errors
    /// [`KinematicsError::UnknownLink`].
    pub fn link(&self, name: &str) -> Result<LinkId, KinematicsError> {
        find_link(name, &self.links)
    }

    /// A link's name.
    pub fn link_name(&self, link: LinkId) -> &str {
        &self.links[link.0]
    }

    /// A link's parent; `None` for the root.
    pub fn parent(&self, link: LinkId) -> Option<LinkId> {
        (link.0 != 0).then(|| LinkId(self.nodes[link.0].parent))
    }

    /// The collision shapes of all links.
    ///
    /// # Errors
    /// [`KinematicsError::Urdf`] with the link whose `<collision>` is faulty; kinematics still works.
    pub fn collision_shapes(&self) -> Result<&[CollisionShape], KinematicsError> {
        self.collision_shapes.as_deref().map_err(Clone::clone)
    }

    /// Masses and inertia tensors of the links that have any.
    ///
    /// # Errors
    /// [`KinematicsError::Urdf`] with the link whose `<inertial>` is faulty; kinematics still works.
    pub fn inertials(&self) -> Result<&[Inertial], KinematicsError> {
        self.inertials.as_deref().map_err(Clone::clone)
    }

    /// Parts of the file that were ignored.
    pub fn warnings(&self) -> &[UrdfWarning] {
        &self.warnings
    }

    /// Nodes from the root's child down to a link.
    pub(crate) fn path(&self, link: LinkId) -> Vec<usize> {
        let mut path = Vec::new();
        let mut index = link.0;
        while index != 0 {
            path.push(index);
            index = self.nodes[index].parent;
        }
        path.reverse();
        path
    }
}

pub(crate) fn find_link(name: &str, links: &[String]) -> Result<LinkId, KinematicsError> {
    links.iter().position(|link| link == name).map(LinkId).ok_or_else(|| unknown_link(name, links))
}

pub(crate) fn unknown_link(name: &str, links: &[String]) -> KinematicsError {
    KinematicsError::UnknownLink { name: name.to_owned(), near: near_names(name, links.iter().map(String::as_str)) }
}
