use nalgebra::{IsometryMatrix3, UnitVector3, Vector3};

use super::{LinkId, RobotModel};
use crate::nodes::{Coupling, Motion, Padded};

/// How a link hangs on its parent: its pose is the parent's, then `origin`, then what the joint does.
///
/// All that forward kinematics needs to know, for those who draw or export a robot.
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
    /// About or along `axis`.
    pub kind: MotionKind,
    /// In the joint's frame.
    pub axis: UnitVector3<f64>,
    /// Place in a configuration; a mimic joint has the place of the joint that it follows in the end.
    pub column: usize,
    /// 1 but for mimic joints.
    pub multiplier: f64,
    /// In radians or metres; 0 but for mimic joints.
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
    /// How a link hangs on its parent; `None` for the root.
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
    // A rotation about −z is kept as one about z, backwards.
    let sign = 1.0_f64.copysign(multiplier);
    let axis = UnitVector3::new_unchecked(axis * sign);
    Some(JointMotion { kind, axis, column, multiplier: sign * multiplier, offset: sign * offset })
}

fn vector([x, y, z, _]: Padded) -> Vector3<f64> {
    Vector3::new(x, y, z)
}
