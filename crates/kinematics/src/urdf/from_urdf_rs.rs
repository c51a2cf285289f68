//! Converts robots read by the crate urdf-rs to [`UrdfRobot`], with the same checks of numbers and names as for a text.

use nalgebra::{IsometryMatrix3, Translation3, Vector3};
use urdf_rs::{Joint, JointLimit, JointType, Link, Pose, Robot};

use super::{
    Element, Geometry, JointKind, Mimic, UrdfCollision, UrdfInertial, UrdfJoint, UrdfMotion, UrdfProblem, UrdfRobot,
    joint::{direction, in_order},
    number::{bounded, each, finite, size},
    origin::fixed_axes,
    version::Version,
};
use crate::KinematicsError;

/// Converts the tags of kinematics and collision.
pub(crate) fn from_urdf_rs(robot: &Robot) -> Result<UrdfRobot, KinematicsError> {
    let version = Version::of(robot.version.as_deref())?;
    let name = |(index, link): (usize, &Link)| named(&link.name, || Element::UnnamedLink(index), "link.name");
    let links: Vec<String> = robot.links.iter().enumerate().map(name).collect::<Result<_, _>>()?;
    if links.is_empty() {
        return Err(KinematicsError::urdf(Element::Robot, UrdfProblem::NoLinks));
    }
    let joints = robot.joints.iter().enumerate();
    let joints = joints.map(|(index, joint)| read_joint(joint, index, version)).collect::<Result<_, _>>()?;
    let collisions = robot.links.iter().enumerate();
    let collisions = collisions.map(|(index, link)| read_collisions(link, index)).collect::<Result<Vec<_>, _>>();
    let collisions = collisions.map(|links| links.concat());
    let inertials = robot.links.iter().enumerate();
    let inertials = inertials.filter_map(|(index, link)| read_inertial(link, index).transpose()).collect();
    Ok(UrdfRobot { name: robot.name.clone(), links, joints, collisions, inertials, warnings: Vec::new() })
}

fn named(name: &str, unnamed: impl FnOnce() -> Element, attribute: &'static str) -> Result<String, KinematicsError> {
    if name.is_empty() {
        return Err(KinematicsError::urdf(unnamed(), UrdfProblem::MissingAttribute { attribute }));
    }
    Ok(name.to_owned())
}

fn read_joint(joint: &Joint, index: usize, version: Version) -> Result<UrdfJoint, KinematicsError> {
    let name = named(&joint.name, || Element::UnnamedJoint(index), "joint.name")?;
    let refused = |problem| KinematicsError::urdf(Element::Joint(joint.name.clone()), problem);
    Ok(UrdfJoint {
        motion: motion(joint, version).map_err(refused)?,
        parent: joint.parent.link.clone(),
        child: joint.child.link.clone(),
        origin: origin(&joint.origin).map_err(refused)?,
        name,
    })
}

fn motion(joint: &Joint, version: Version) -> Result<UrdfMotion, UrdfProblem> {
    match joint.joint_type {
        JointType::Fixed => Ok(UrdfMotion::Fixed),
        JointType::Revolute => moving(joint, JointKind::Revolute, version),
        JointType::Continuous => moving(joint, JointKind::Continuous, version),
        JointType::Prismatic => moving(joint, JointKind::Prismatic, version),
        JointType::Floating => Err(UrdfProblem::UnsupportedJoint { kind: "floating" }),
        JointType::Planar => Err(UrdfProblem::UnsupportedJoint { kind: "planar" }),
        JointType::Spherical => Err(UrdfProblem::JointType { found: "spherical".to_owned() }),
    }
}

fn moving(joint: &Joint, kind: JointKind, version: Version) -> Result<UrdfMotion, UrdfProblem> {
    let axis = direction(Vector3::from(each("axis.xyz", *joint.axis.xyz, finite)?))?;
    let (lower, upper) = match kind {
        JointKind::Continuous => (f64::NEG_INFINITY, f64::INFINITY),
        JointKind::Revolute | JointKind::Prismatic => limits(&joint.limit, version)?,
    };
    let mimic = joint.mimic.as_ref().map(|mimic| {
        Ok(Mimic {
            target: mimic.joint.clone(),
            multiplier: bounded("mimic.multiplier", mimic.multiplier.unwrap_or(1.0))?,
            offset: bounded("mimic.offset", mimic.offset.unwrap_or(0.0))?,
        })
    });
    Ok(UrdfMotion::Moving { kind, axis, lower, upper, mimic: mimic.transpose()? })
}

/// Lower and upper limit. urdf-rs does not distinguish a missing `<limit>` from one of zeros alone, nor a missing bound
/// of URDF 1.2 from an infinite one; both count as missing.
fn limits(limit: &JointLimit, version: Version) -> Result<(f64, f64), UrdfProblem> {
    if *limit == JointLimit::default() {
        return Err(UrdfProblem::MissingLimit);
    }
    let bound = |attribute, bound, value: f64| match value {
        f64::INFINITY | f64::NEG_INFINITY if !version.has_optional_bounds() => Err(UrdfProblem::MissingBound { bound }),
        _ => finite(attribute, value),
    };
    in_order(bound("limit.lower", "lower", limit.lower)?, bound("limit.upper", "upper", limit.upper)?)
}

fn origin(pose: &Pose) -> Result<IsometryMatrix3<f64>, UrdfProblem> {
    let translation = Translation3::from(each("origin.xyz", *pose.xyz, bounded)?);
    let [roll, pitch, yaw] = each("origin.rpy", *pose.rpy, bounded)?;
    Ok(IsometryMatrix3::from_parts(translation, fixed_axes(roll, pitch, yaw)))
}

fn read_collisions(link: &Link, index: usize) -> Result<Vec<UrdfCollision>, KinematicsError> {
    let read = |collision: &urdf_rs::Collision| {
        Ok(UrdfCollision { link: index, origin: origin(&collision.origin)?, geometry: shape(&collision.geometry)? })
    };
    let refused = |problem| KinematicsError::urdf(Element::Link(link.name.clone()), problem);
    link.collision.iter().map(|collision| read(collision).map_err(refused)).collect()
}

fn read_inertial(link: &Link, index: usize) -> Result<Option<UrdfInertial>, KinematicsError> {
    let urdf_rs::Inertial { origin: pose, mass, inertia } = &link.inertial;
    let urdf_rs::Inertia { ixx, ixy, ixz, iyy, iyz, izz } = *inertia;
    let read = origin(pose).and_then(|pose| UrdfInertial::of(index, pose, mass.value, [ixx, ixy, ixz, iyy, iyz, izz]));
    read.map_err(|problem| KinematicsError::urdf(Element::Link(link.name.clone()), problem))
}

fn shape(geometry: &urdf_rs::Geometry) -> Result<Geometry, UrdfProblem> {
    Ok(match geometry {
        urdf_rs::Geometry::Box { size: lengths } => {
            Geometry::Box { size: Vector3::from(each("box.size", **lengths, size)?) }
        }
        urdf_rs::Geometry::Sphere { radius } => Geometry::Sphere { radius: size("sphere.radius", *radius)? },
        urdf_rs::Geometry::Cylinder { radius, length } => {
            Geometry::Cylinder { radius: size("cylinder.radius", *radius)?, length: size("cylinder.length", *length)? }
        }
        urdf_rs::Geometry::Capsule { radius, length } => {
            Geometry::Capsule { radius: size("capsule.radius", *radius)?, length: size("capsule.length", *length)? }
        }
        urdf_rs::Geometry::Mesh { filename, scale } => {
            let scale = scale.map_or(Ok([1.0; 3]), |scale| each("mesh.scale", *scale, bounded))?;
            Geometry::Mesh { filename: filename.clone(), scale: Vector3::from(scale) }
        }
    })
}
