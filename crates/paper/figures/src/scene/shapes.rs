//! Shapes of robots as stored in documents, and detection of limbs.

use anyhow::bail;
use kinematics::{CollisionShape, Geometry, LinkPoses, RobotModel};
use nalgebra::{IsometryMatrix3, Matrix3, Point3, Rotation3, Translation3, Vector3};
use serde::{Deserialize, Serialize};

use crate::rounded;

/// A shape and its pose, metres, as stored in documents. `Link` identifies its link, either by name, with a pose in the
/// frame of the root, or by index in a tree, with a pose in the link's frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Shape<Link = String> {
    pub(crate) link: Link,
    pub(crate) kind: Kind,
    /// \[radius\], \[radius, length along z\], or full lengths along x, y, z.
    pub(crate) size: Vec<f64>,
    pub(crate) translation: [f64; 3],
    /// Row-major.
    pub(crate) rotation: [f64; 9],
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Kind {
    Sphere,
    Cylinder,
    Box,
}

/// Two spheres and a cylinder form one limb if their ends and radii differ by less than this, metres.
const SAME: f64 = 1e-4;

/// All collision shapes of a robot in these poses.
pub(crate) fn posed(robot: &RobotModel, poses: &LinkPoses<'_>) -> anyhow::Result<Vec<Shape>> {
    let shape = |CollisionShape { link, origin, geometry }: &CollisionShape| {
        let (kind, size) = form(geometry)?;
        let pose = poses.pose(*link) * origin;
        let (translation, rotation) = seen(&pose);
        Ok(Shape { link: robot.link_name(*link).to_owned(), kind, size, translation, rotation })
    };
    robot.collision_shapes()?.iter().map(shape).collect()
}

/// A shape as stored in documents.
pub(crate) fn form(geometry: &Geometry) -> anyhow::Result<(Kind, Vec<f64>)> {
    Ok(match geometry {
        Geometry::Sphere { radius } => (Kind::Sphere, vec![*radius]),
        Geometry::Cylinder { radius, length } => (Kind::Cylinder, vec![*radius, *length]),
        Geometry::Box { size } => (Kind::Box, size.iter().copied().collect()),
        other => bail!("the form of the figure data has no words for {other:?}"),
    })
}

/// Translation, and row-major rotation.
pub(crate) fn numbers(pose: &IsometryMatrix3<f64>) -> ([f64; 3], [f64; 9]) {
    let rotation = pose.rotation.matrix();
    (pose.translation.vector.into(), std::array::from_fn(|at| rotation[(at / 3, at % 3)]))
}

/// The same, rounded to a hundredth of a millimetre, which suffices for drawing.
pub(crate) fn seen(pose: &IsometryMatrix3<f64>) -> ([f64; 3], [f64; 9]) {
    let (translation, rotation) = numbers(pose);
    (translation.map(|value| rounded(value, 5)), rotation.map(|value| rounded(value, 6)))
}

/// A pose from its numbers in a document.
pub(crate) fn pose(translation: &[f64; 3], rotation: &[f64; 9]) -> IsometryMatrix3<f64> {
    let rotation = Rotation3::from_matrix_unchecked(Matrix3::from_row_slice(rotation));
    IsometryMatrix3::from_parts(Translation3::from(Vector3::from(*translation)), rotation)
}

/// Cylinders with a sphere at either end: the indices of all three, and the ends.
pub(crate) fn limbs<Link: PartialEq>(shapes: &[Shape<Link>]) -> Vec<(usize, [usize; 2], [Point3<f64>; 2])> {
    let limb = |(at, shape)| caps(shape, shapes).map(|(caps, ends)| (at, caps, ends));
    shapes.iter().enumerate().filter_map(limb).collect()
}

/// The spheres of the same link and radius at the ends of a cylinder, and the ends.
fn caps<Link: PartialEq>(shape: &Shape<Link>, shapes: &[Shape<Link>]) -> Option<([usize; 2], [Point3<f64>; 2])> {
    let (Kind::Cylinder, &[radius, length]) = (shape.kind, &shape.size[..]) else { return None };
    let [bottom, top] = ends(&pose(&shape.translation, &shape.rotation), length);
    let at = |end: Point3<f64>| {
        shapes.iter().position(|other| {
            let near = (Point3::from(other.translation) - end).norm() < SAME;
            other.kind == Kind::Sphere && other.link == shape.link && near && (other.size[0] - radius).abs() < SAME
        })
    };
    Some(([at(bottom)?, at(top)?], [bottom, top]))
}

pub(crate) fn ends(pose: &IsometryMatrix3<f64>, length: f64) -> [Point3<f64>; 2] {
    [-0.5, 0.5].map(|share| pose * Point3::new(0.0, 0.0, share * length))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_document_keeps_a_pose_to_a_hundredth_of_a_millimetre() {
        let rotation = Rotation3::from_euler_angles(0.3, -1.2, 2.5);
        let whole = IsometryMatrix3::from_parts(Translation3::new(0.123456789, -4.0, 0.7), rotation);
        let (translation, rotation) = seen(&whole);
        let point = Point3::new(0.3, -0.2, 0.5);
        assert!((pose(&translation, &rotation) * point - whole * point).norm() < 1e-5);
    }
}
