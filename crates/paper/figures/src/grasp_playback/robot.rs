//! The robot as a kinematic tree that any language can evaluate in a few lines.

use anyhow::{Context as _, bail};
use demo_gen::UpperBody;
use kinematics::{CollisionShape, JointMotion, LinkId, MotionKind, RobotModel};
use nalgebra::IsometryMatrix3;
use serde::{Deserialize, Serialize};

use crate::scene::shapes::{Shape, form, numbers};
use crate::sound::{self, among, within};

/// Bound on distances, metres.
pub(super) const FARTHEST: f64 = 10.0;

/// The links and their shapes.
#[derive(Serialize, Deserialize)]
pub(crate) struct Robot {
    /// Parents come before their children.
    pub(crate) links: Vec<Link>,
    pub(crate) shapes: Vec<Shape<usize>>,
    /// Indices of the left and the right palm in `links`.
    pub(crate) hands: [usize; 2],
    /// Joint names, in the order of a configuration.
    pub(crate) joints: Vec<String>,
}

/// The pose of a link is its parent's pose, followed by translation, rotation, and the motion of its joint.
#[derive(Serialize, Deserialize)]
pub(crate) struct Link {
    pub(crate) name: String,
    /// Index in `links`; `None` for the first.
    pub(crate) parent: Option<usize>,
    pub(crate) translation: [f64; 3],
    /// Row-major.
    pub(crate) rotation: [f64; 9],
    pub(crate) motion: Motion,
    /// Unit vector in the joint's frame.
    pub(crate) axis: [f64; 3],
    /// Index in a configuration.
    pub(crate) joint: Option<usize>,
}

/// How a joint moves, about or along its axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Motion {
    Fixed,
    Turn,
    Slide,
}

impl Robot {
    /// Checks that all indices of links, joints and shapes are valid, and returns the number of joints.
    pub(super) fn check(&self) -> anyhow::Result<usize> {
        let (links, joints) = (self.links.len(), self.joints.len());
        for (place, link) in self.links.iter().enumerate() {
            among("a parent", link.parent.as_slice(), place)?;
            among("a joint", link.joint.as_slice(), joints)?;
            within("a link", &[link.translation, link.axis].concat(), FARTHEST)?;
            within("a rotation", &link.rotation, FARTHEST)?;
        }
        for shape in &self.shapes {
            among("a shape's link", &[shape.link], links)?;
            sound::size(shape.kind, &shape.size)?;
            within("a shape", &[&shape.size[..], &shape.translation, &shape.rotation].concat(), FARTHEST)?;
        }
        among("hands", &self.hands, links)?;
        Ok(joints)
    }
}

pub(crate) fn robot(body: &UpperBody) -> anyhow::Result<Robot> {
    let robot = body.robot();
    let links: Vec<LinkId> = robot.links().collect();
    let place = |link: LinkId| links.iter().position(|other| *other == link).context("a link of another robot");
    let hand = |name: &str| place(robot.link(name)?);
    Ok(Robot {
        links: links.iter().map(|link| self::link(robot, *link, place)).collect::<anyhow::Result<_>>()?,
        shapes: robot
            .collision_shapes()?
            .iter()
            .map(|shape| self::shape(shape, place))
            .collect::<anyhow::Result<_>>()?,
        hands: [hand("l_palm")?, hand("r_palm")?],
        joints: robot.joints().iter().map(|joint| joint.name().to_owned()).collect(),
    })
}

fn link(robot: &RobotModel, link: LinkId, place: impl Fn(LinkId) -> anyhow::Result<usize>) -> anyhow::Result<Link> {
    let name = robot.link_name(link).to_owned();
    let attachment = robot.attachment(link);
    let origin = attachment.as_ref().map_or(IsometryMatrix3::identity(), |attachment| attachment.origin);
    let parent = attachment.as_ref().map(|attachment| place(attachment.parent)).transpose()?;
    let joint = attachment.and_then(|attachment| attachment.joint);
    if joint.is_some_and(|joint| (joint.multiplier, joint.offset) != (1.0, 0.0)) {
        bail!("link {name} follows another joint, which the form of the figure data has no words for");
    }
    let (motion, axis) = joint.map_or((Motion::Fixed, [0.0, 0.0, 1.0]), |JointMotion { kind, axis, .. }| {
        (if kind == MotionKind::Rotation { Motion::Turn } else { Motion::Slide }, axis.into_inner().into())
    });
    let (translation, rotation) = numbers(&origin);
    Ok(Link { name, parent, translation, rotation, motion, axis, joint: joint.map(|joint| joint.column) })
}

fn shape(shape: &CollisionShape, place: impl Fn(LinkId) -> anyhow::Result<usize>) -> anyhow::Result<Shape<usize>> {
    let (kind, size) = form(&shape.geometry)?;
    let (translation, rotation) = numbers(&shape.origin);
    Ok(Shape { link: place(shape.link)?, kind, size, translation, rotation })
}
