//! Robots as pictures show them: posed shapes, limbs in one piece.

use anyhow::bail;
use kinematics::{CollisionShape, Geometry, LinkPoses, RobotModel};
use nalgebra::{IsometryMatrix3, Matrix3, Point3, Rotation3, Translation3, Vector3};
use plot::{Item, Paint};
use serde::{Deserialize, Serialize};

use super::legs::{eyes, standing};
use super::rounded;

/// A shape and its pose, metres: as documents hold it. `Link` says which link it is a part of: by name, then its pose is
/// in the frame of the root; or by its place in a tree, then its pose is in the link's own frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Shape<Link = String> {
    pub(crate) link: Link,
    pub(crate) kind: Kind,
    /// \[radius\], \[radius, length along z\], or whole lengths along x, y, z.
    pub(crate) size: Vec<f64>,
    pub(crate) translation: [f64; 3],
    /// By rows.
    pub(crate) rotation: [f64; 9],
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Kind {
    Sphere,
    Cylinder,
    Box,
}

/// Links that are drawn with more than their shapes.
const HEEL: &str = "heel";
const HEAD: &str = "head";

/// Two spheres and a cylinder whose ends and radii differ by less than this are one limb, metres.
const SAME: f64 = 1e-4;

/// All collision shapes of a robot in these poses.
pub(super) fn posed(robot: &RobotModel, poses: &LinkPoses<'_>) -> anyhow::Result<Vec<Shape>> {
    let shape = |CollisionShape { link, origin, geometry }: &CollisionShape| {
        let (kind, size) = form(geometry)?;
        let pose = poses.pose(*link) * origin;
        let (translation, rotation) = seen(&pose);
        Ok(Shape { link: robot.link_name(*link).to_owned(), kind, size, translation, rotation })
    };
    robot.collision_shapes()?.iter().map(shape).collect()
}

/// A shape as documents hold it.
pub(super) fn form(geometry: &Geometry) -> anyhow::Result<(Kind, Vec<f64>)> {
    Ok(match geometry {
        Geometry::Sphere { radius } => (Kind::Sphere, vec![*radius]),
        Geometry::Cylinder { radius, length } => (Kind::Cylinder, vec![*radius, *length]),
        Geometry::Box { size } => (Kind::Box, size.iter().copied().collect()),
        other => bail!("the form of the figure data has no words for {other:?}"),
    })
}

/// Translation, and rotation by rows.
pub(super) fn numbers(pose: &IsometryMatrix3<f64>) -> ([f64; 3], [f64; 9]) {
    let rotation = pose.rotation.matrix();
    (pose.translation.vector.into(), std::array::from_fn(|at| rotation[(at / 3, at % 3)]))
}

/// The same, to a hundredth of a millimetre: what can be seen.
pub(super) fn seen(pose: &IsometryMatrix3<f64>) -> ([f64; 3], [f64; 9]) {
    let (translation, rotation) = numbers(pose);
    (translation.map(|value| rounded(value, 5)), rotation.map(|value| rounded(value, 6)))
}

/// A pose that a document holds.
pub(super) fn pose(translation: &[f64; 3], rotation: &[f64; 9]) -> IsometryMatrix3<f64> {
    let rotation = Rotation3::from_matrix_unchecked(Matrix3::from_row_slice(rotation));
    IsometryMatrix3::from_parts(Translation3::from(Vector3::from(*translation)), rotation)
}

/// The shapes as things in space, each painted after its link; a cylinder with a sphere at either end is a limb. Legs are
/// bent as the trunk has moved from where it is at rest, and a head has eyes.
pub(super) fn items(shapes: &[Shape], trunk: &IsometryMatrix3<f64>, paint: impl Fn(&str) -> Paint) -> Vec<Item> {
    let limbs = limbs(shapes);
    let legs = standing(shapes, &HEEL.to_owned());
    let is_cap = |index: usize| limbs.iter().any(|(_, caps, _)| caps.contains(&index));
    let item = |(index, shape): (usize, &Shape)| {
        let paint = paint(&shape.link);
        let limb = limbs.iter().any(|(cylinder, ..)| *cylinder == index);
        let pose = pose(&shape.translation, &shape.rotation);
        match (shape.kind, &shape.size[..]) {
            _ if legs.iter().any(|leg| leg.parts.contains(&index)) => None,
            (Kind::Sphere, _) if is_cap(index) => None,
            (Kind::Sphere, &[radius]) => Some(Item::Ball { centre: pose * Point3::origin(), radius, paint }),
            (Kind::Cylinder, &[radius, length]) if limb => {
                Some(Item::Capsule { ends: ends(&pose, length), radius, paint })
            }
            (Kind::Cylinder, &[radius, length]) => Some(Item::Cylinder { ends: ends(&pose, length), radius, paint }),
            (Kind::Box, &[x, y, z]) => Some(Item::Block { pose, size: Vector3::new(x, y, z), paint }),
            _ => None,
        }
    };
    let drawn = shapes.iter().enumerate().filter_map(item);
    let legs = legs.iter().flat_map(|leg| leg.items(trunk, paint(HEEL)));
    let heads = shapes.iter().filter(|shape| shape.link == HEAD);
    drawn.chain(legs).chain(heads.flat_map(eyes)).collect()
}

/// Cylinders with a sphere at either end: places of all three, and the ends.
pub(super) fn limbs<Link: PartialEq>(shapes: &[Shape<Link>]) -> Vec<(usize, [usize; 2], [Point3<f64>; 2])> {
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

fn ends(pose: &IsometryMatrix3<f64>, length: f64) -> [Point3<f64>; 2] {
    [-0.5, 0.5].map(|share| pose * Point3::new(0.0, 0.0, share * length))
}

#[cfg(test)]
mod tests {
    use experiments::upper_body;
    use kinematics::Workspace;

    use super::*;

    #[test]
    fn limbs_are_in_one_piece() {
        let body = upper_body().unwrap();
        let mut workspace = Workspace::new();
        let poses = body.robot().forward_kinematics(body.ready().as_view(), &mut workspace).unwrap();
        let shapes = posed(body.robot(), &poses).unwrap();
        let items = items(&shapes, &IsometryMatrix3::identity(), |_| Paint::opaque("#ffffff"));
        let count = |is: fn(&Item) -> bool| items.iter().filter(|item| is(item)).count();
        // Two shins and thighs, two upper arms, two forearms; head and eyes; the neck; feet, body in three, hands.
        assert_eq!(count(|item| matches!(item, Item::Capsule { .. })), 8);
        assert_eq!(count(|item| matches!(item, Item::Ball { .. })), 3);
        assert_eq!(count(|item| matches!(item, Item::Cylinder { .. })), 1);
        assert_eq!(count(|item| matches!(item, Item::Block { .. })), 7);
        assert_eq!(items.len(), 19);
    }

    #[test]
    fn a_document_keeps_a_pose_to_a_hundredth_of_a_millimetre() {
        let rotation = Rotation3::from_euler_angles(0.3, -1.2, 2.5);
        let whole = IsometryMatrix3::from_parts(Translation3::new(0.123456789, -4.0, 0.7), rotation);
        let (translation, rotation) = seen(&whole);
        let point = Point3::new(0.3, -0.2, 0.5);
        assert!((pose(&translation, &rotation) * point - whole * point).norm() < 1e-5);
    }
}
