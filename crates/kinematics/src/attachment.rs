use nalgebra::{IsometryMatrix3, UnitVector3, Vector3};

use crate::{LinkId, RobotModel, node::Motion, placement::Lanes, workspace::Motor};

/// How a link hangs on its parent: its pose is the parent's, then `origin`, then what the joint does.
///
/// All that forward kinematics needs to know, for those who draw or export a robot.
#[derive(Debug, Clone, PartialEq)]
pub struct Attachment {
    /// The link that carries this one.
    pub parent: LinkId,
    /// The joint's frame in the parent's frame, metres.
    pub origin: IsometryMatrix3<f64>,
    /// What the joint does; `None` for a fixed one.
    pub drive: Option<Drive>,
}

/// What a moving joint does: a turn or a slide by `multiplier` · q\[`column`\] + `offset`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drive {
    /// About or along `axis`.
    pub kind: DriveKind,
    /// In the joint's frame.
    pub axis: UnitVector3<f64>,
    /// Place in a configuration; a mimic joint has the place of the joint that it follows in the end.
    pub column: usize,
    /// 1 but for mimic joints.
    pub multiplier: f64,
    /// In radians or metres; 0 but for mimic joints.
    pub offset: f64,
}

/// A turn or a slide.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DriveKind {
    /// About the axis, in radians.
    Turn,
    /// Along the axis, in metres.
    Slide,
}

impl RobotModel {
    /// How a link hangs on its parent; `None` for the root.
    pub fn attachment(&self, link: LinkId) -> Option<Attachment> {
        let parent = self.parent(link)?;
        let node = &self.nodes[link.0];
        let drive = node.motor.and_then(|motor| drive(node.motion, self.motors[motor]));
        Some(Attachment { parent, origin: self.origins[link.0], drive })
    }
}

fn drive(motion: Motion, Motor { column, multiplier, offset }: Motor) -> Option<Drive> {
    let (kind, axis) = match motion {
        Motion::Fixed => return None,
        Motion::TurnX => (DriveKind::Turn, Vector3::x()),
        Motion::TurnY => (DriveKind::Turn, Vector3::y()),
        Motion::TurnZ => (DriveKind::Turn, Vector3::z()),
        Motion::Turn(axis) => (DriveKind::Turn, vector(axis)),
        Motion::Slide(axis) => (DriveKind::Slide, vector(axis)),
    };
    // A turn about −z is kept as one about z, backwards.
    let sign = 1.0_f64.copysign(multiplier);
    let axis = UnitVector3::new_unchecked(axis * sign);
    Some(Drive { kind, axis, column, multiplier: sign * multiplier, offset: sign * offset })
}

fn vector([x, y, z, _]: Lanes) -> Vector3<f64> {
    Vector3::new(x, y, z)
}
