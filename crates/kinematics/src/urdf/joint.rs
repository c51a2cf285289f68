use nalgebra::{IsometryMatrix3, Unit, Vector3};
use roxmltree::Node;

use super::{
    Element, UrdfProblem, UrdfWarning, origin,
    tag::{Tag, name_of},
    version::Version,
};
use crate::KinematicsError;

/// A joint as the file describes it; links and mimic targets are names not yet resolved.
#[derive(Debug, Clone)]
pub(crate) struct UrdfJoint {
    pub(crate) name: String,
    pub(crate) parent: String,
    pub(crate) child: String,
    pub(crate) origin: IsometryMatrix3<f64>,
    pub(crate) motion: UrdfMotion,
}

impl UrdfJoint {
    /// The error for a rule that this joint breaks.
    pub(crate) fn error(&self, problem: UrdfProblem) -> KinematicsError {
        KinematicsError::urdf(Element::Joint(self.name.clone()), problem)
    }
}

/// Type of a joint.
#[derive(Debug, Clone)]
pub(crate) enum UrdfMotion {
    Fixed,
    Moving { kind: JointKind, axis: Unit<Vector3<f64>>, lower: f64, upper: f64, mimic: Option<Mimic> },
}

/// q = multiplier · q(target) + offset.
#[derive(Debug, Clone)]
pub(crate) struct Mimic {
    pub(crate) target: String,
    pub(crate) multiplier: f64,
    pub(crate) offset: f64,
}

/// Type of an active joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum JointKind {
    /// A rotation between two limits, in radians.
    Revolute,
    /// A rotation without limits, one angle in radians that may pass ±π.
    Continuous,
    /// A displacement between two limits, in metres.
    Prismatic,
}

pub(super) fn read(
    node: Node<'_, '_>,
    index: usize,
    version: Version,
    warnings: &mut Vec<UrdfWarning>,
) -> Result<UrdfJoint, KinematicsError> {
    let name = name_of(node, || Element::UnnamedJoint(index), "joint.name")?;
    let owner = Element::Joint(name.clone());
    let joint = Tag { node, owner: &owner };
    let motion = match joint.text("joint.type")?.as_str() {
        "fixed" => UrdfMotion::Fixed,
        "revolute" => moving(joint, JointKind::Revolute, version)?,
        "continuous" => moving(joint, JointKind::Continuous, version)?,
        "prismatic" => moving(joint, JointKind::Prismatic, version)?,
        "floating" => return Err(joint.error(UrdfProblem::UnsupportedJoint { kind: "floating" })),
        "planar" => return Err(joint.error(UrdfProblem::UnsupportedJoint { kind: "planar" })),
        found => return Err(joint.error(UrdfProblem::JointType { found: found.to_owned() })),
    };
    let link = |tag: &'static str, attribute| match joint.child(tag) {
        Some(link) => link.text(attribute),
        None => Err(joint.error(UrdfProblem::MissingTag { tag })),
    };
    Ok(UrdfJoint {
        parent: link("parent", "parent.link")?,
        child: link("child", "child.link")?,
        origin: origin::read(joint, version, warnings)?,
        motion,
        name,
    })
}

fn moving(joint: Tag<'_>, kind: JointKind, version: Version) -> Result<UrdfMotion, KinematicsError> {
    let axis = axis(joint)?;
    let (lower, upper) = match kind {
        JointKind::Continuous => (f64::NEG_INFINITY, f64::INFINITY),
        JointKind::Revolute | JointKind::Prismatic => limits(joint, version)?,
    };
    Ok(UrdfMotion::Moving { kind, axis, lower, upper, mimic: mimic(joint)? })
}

/// The axis as a unit vector; x by default.
fn axis(joint: Tag<'_>) -> Result<Unit<Vector3<f64>>, KinematicsError> {
    let Some(axis) = joint.child("axis") else { return Ok(Vector3::x_axis()) };
    let xyz = axis.numbers::<3>("axis.xyz")?.map_or_else(Vector3::x, Vector3::from);
    direction(xyz).map_err(|problem| joint.error(problem))
}

/// An axis as a unit vector.
pub(super) fn direction(xyz: Vector3<f64>) -> Result<Unit<Vector3<f64>>, UrdfProblem> {
    // Scaled first, so that no square overflows or underflows.
    Unit::try_new(xyz / xyz.amax(), 0.0).ok_or(UrdfProblem::ZeroAxis)
}

/// Lower and upper limit. Up to version 1.1, a missing bound is 0.
fn limits(joint: Tag<'_>, version: Version) -> Result<(f64, f64), KinematicsError> {
    let limit = joint.child("limit").ok_or_else(|| joint.error(UrdfProblem::MissingLimit))?;
    let bound = |attribute, bound| match limit.number(attribute)? {
        Some(value) => Ok(value),
        None if version.has_optional_bounds() => Ok(0.0),
        None => Err(joint.error(UrdfProblem::MissingBound { bound })),
    };
    let (lower, upper) = (bound("limit.lower", "lower")?, bound("limit.upper", "upper")?);
    in_order(lower, upper).map_err(|problem| joint.error(problem))
}

/// A pair of limits, which must be in order.
pub(super) fn in_order(lower: f64, upper: f64) -> Result<(f64, f64), UrdfProblem> {
    if lower > upper { Err(UrdfProblem::LimitsInverted { lower, upper }) } else { Ok((lower, upper)) }
}

fn mimic(joint: Tag<'_>) -> Result<Option<Mimic>, KinematicsError> {
    let Some(mimic) = joint.child("mimic") else { return Ok(None) };
    Ok(Some(Mimic {
        target: mimic.text("mimic.joint")?,
        multiplier: mimic.bounded("mimic.multiplier")?.map_or(1.0, |[multiplier]| multiplier),
        offset: mimic.bounded("mimic.offset")?.map_or(0.0, |[offset]| offset),
    }))
}
