use nalgebra::{IsometryMatrix3, UnitVector3, Vector3};

use super::{LinkId, RobotModel};
use crate::nodes::{Coupling, Motion, Padded};

/// How a link is attached to its parent: its pose is the parent's, followed by `origin` and the
/// joint's motion.
///
/// This is all that forward kinematics uses, for programs that draw or export a robot.
#[derive(Debug, Clone, PartialEq)]
pub struct Attachment {
    /// The link that carries this one.
    pub parent: LinkId,
    /// The joint's frame in the parent's frame, metres.
    pub origin: IsometryMatrix3<f64>,
    /// The joint's motion; `None` for a fixed one.
    pub joint: Option<JointMotion>,
}

/// The motion of a joint: a rotation or a translation by `multiplier` · q\[`column`\] + `offset`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointMotion {
    /// Rotation about `axis` or translation along it.
    pub kind: MotionKind,
    /// The axis in the joint's frame.
    pub axis: UnitVector3<f64>,
    /// Index in a configuration; for a mimic joint, that of the joint that it ultimately follows.
    pub column: usize,
    /// 1 except for mimic joints.
    pub multiplier: f64,
    /// In radians or metres; 0 except for mimic joints.
    pub offset: f64,
}

/// A rotation or a translation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MotionKind {
    /// About the axis, in radians.
    Rotation,
    /// Along the axis, in metres.
    Translation,
}

impl RobotModel {
    /// How a link is attached to its parent; `None` for the root.
    pub fn attachment(&self, link: LinkId) -> Option<Attachment> {
        let parent = self.parent(link)?;
        let node = &self.nodes[link.0];
        let joint = node.coupling.and_then(|coupling| joint_motion(node.motion, self.couplings[coupling]));
        Some(Attachment { parent, origin: self.origins[link.0], joint })
    }
}

fn joint_motion(motion: Motion, Coupling { column, multiplier, offset }: Coupling) -> Option<JointMotion> {
    let (kind, axis) = match motion {
        Motion::Fixed => return None,
        Motion::RotationX => (MotionKind::Rotation, Vector3::x()),
        Motion::RotationY => (MotionKind::Rotation, Vector3::y()),
        Motion::RotationZ => (MotionKind::Rotation, Vector3::z()),
        Motion::Rotation(axis) => (MotionKind::Rotation, vector(axis)),
        Motion::Translation(axis) => (MotionKind::Translation, vector(axis)),
    };
    // A rotation about −z is stored as the reverse rotation about z.
    let sign = 1.0_f64.copysign(multiplier);
    let axis = UnitVector3::new_unchecked(axis * sign);
    Some(JointMotion { kind, axis, column, multiplier: sign * multiplier, offset: sign * offset })
}

fn vector([x, y, z, _]: Padded) -> Vector3<f64> {
    Vector3::new(x, y, z)
}
