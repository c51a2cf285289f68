//! The only module that uses the collision library and its vector types.

use nalgebra::{IsometryMatrix3, Point3, UnitQuaternion, UnitVector3, Vector3};
use parry3d_f64::{
    glamx::DQuat,
    math::{Pose, Vector},
    query,
    shape::SharedShape,
};

use super::mesh::MeshShape;
use crate::{Geometry, urdf::LARGEST};

/// A shape, fixed in a link's frame.
#[derive(Clone)]
pub(super) struct PlacedShape {
    shape: SharedShape,
    pose: Pose,
}

impl std::fmt::Debug for PlacedShape {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("PlacedShape").field("shape", &self.shape.shape_type()).field("pose", &self.pose).finish()
    }
}

impl PlacedShape {
    /// A shape other than a mesh.
    pub(super) fn primitive(geometry: &Geometry, origin: &IsometryMatrix3<f64>) -> Option<Self> {
        let pose = pose(origin);
        let shape = match *geometry {
            Geometry::Box { size } => SharedShape::cuboid(size.x / 2.0, size.y / 2.0, size.z / 2.0),
            Geometry::Sphere { radius } => SharedShape::ball(radius),
            Geometry::Capsule { radius, length } => SharedShape::capsule_z(length / 2.0, radius),
            // A cylinder's axis is y in the library and z here.
            Geometry::Cylinder { radius, length } => {
                let upright = Pose::from_parts(Vector::ZERO, DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2));
                return Some(PlacedShape { shape: SharedShape::cylinder(length / 2.0, radius), pose: pose * upright });
            }
            Geometry::Mesh { .. } => return None,
        };
        Some(PlacedShape { shape, pose })
    }

    /// A mesh, or the reason why it is not a shape.
    pub(super) fn mesh(
        mesh: MeshShape,
        scale: &Vector3<f64>,
        origin: &IsometryMatrix3<f64>,
    ) -> Result<Option<Self>, String> {
        let scaled = |vertices: Vec<Point3<f64>>| -> Result<Vec<Vector>, String> {
            let scaled = vertices.into_iter().map(|vertex| vertex.coords.component_mul(scale));
            // The condition also rejects NaN. The collision library itself overflows at much larger values.
            let near = |v: Vector3<f64>| v.iter().all(|part| part.abs() <= LARGEST).then(|| Vector::new(v.x, v.y, v.z));
            scaled.map(near).collect::<Option<_>>().ok_or_else(|| "a vertex is not finite, or beyond 1e6 m".to_owned())
        };
        let shape = match mesh {
            MeshShape::LeftOut => return Ok(None),
            MeshShape::ConvexHull { vertices } => {
                SharedShape::convex_hull(&scaled(vertices)?).ok_or("its points span no volume")?
            }
            MeshShape::Surface { vertices, triangles } => {
                if triangles.iter().flatten().any(|&vertex| vertex as usize >= vertices.len()) {
                    return Err("a triangle names a vertex that is not there".to_owned());
                }
                SharedShape::trimesh(scaled(vertices)?, triangles).map_err(|error| error.to_string())?
            }
        };
        Ok(Some(PlacedShape { shape, pose: pose(origin) }))
    }

    /// A bounding sphere in the link's frame.
    pub(super) fn bounding_sphere(&self) -> (Point3<f64>, f64) {
        let sphere = self.shape.compute_bounding_sphere(&self.pose);
        let Vector { x, y, z } = sphere.center();
        (Point3::new(x, y, z), sphere.radius())
    }
}

/// Whether two shapes touch, each with its link's pose.
pub(super) fn touch(first: (&PlacedShape, &LinkPose), second: (&PlacedShape, &LinkPose)) -> bool {
    let ((a, at_a), (b, at_b)) = (first, second);
    query::intersection_test(&(at_a.0 * a.pose), &*a.shape, &(at_b.0 * b.pose), &*b.shape)
        .expect("the collision library knows every pair of these shapes")
        .intersecting
}

/// The distance of two shapes in metres, each with its link's pose; 0 if they touch.
pub(super) fn distance(first: (&PlacedShape, &LinkPose), second: (&PlacedShape, &LinkPose)) -> f64 {
    let ((a, at_a), (b, at_b)) = (first, second);
    query::distance(&(at_a.0 * a.pose), &*a.shape, &(at_b.0 * b.pose), &*b.shape)
        .expect("the collision library knows every pair of these shapes")
        .distance
}

/// The points of smallest distance, or deepest penetration, of two shapes.
pub(super) struct Contact {
    /// Negative if they overlap.
    pub(super) distance: f64,
    pub(super) points: (Point3<f64>, Point3<f64>),
    /// Direction from the first to the second.
    pub(super) normal: UnitVector3<f64>,
}

/// The contact of two shapes, each with its link's pose, that are nearer than `within` metres. `None` if they are
/// not, or if the library finds no way out of an overlap.
pub(super) fn contact(
    first: (&PlacedShape, &LinkPose),
    second: (&PlacedShape, &LinkPose),
    within: f64,
) -> Option<Contact> {
    let ((a, at_a), (b, at_b)) = (first, second);
    let contact = query::contact(&(at_a.0 * a.pose), &*a.shape, &(at_b.0 * b.pose), &*b.shape, within)
        .expect("the collision library knows every pair of these shapes")?;
    let vector = |v: Vector| Vector3::new(v.x, v.y, v.z);
    let normal = UnitVector3::try_new(vector(contact.normal1), f64::EPSILON)?;
    let points = (vector(contact.point1).into(), vector(contact.point2).into());
    Some(Contact { distance: contact.dist, points, normal })
}

/// A link's pose in the library's type.
pub(super) struct LinkPose(Pose);

impl LinkPose {
    pub(super) fn new(isometry: &IsometryMatrix3<f64>) -> Self {
        LinkPose(pose(isometry))
    }
}

fn pose(isometry: &IsometryMatrix3<f64>) -> Pose {
    let t = isometry.translation.vector;
    let q = UnitQuaternion::from_rotation_matrix(&isometry.rotation);
    Pose::from_parts(Vector::new(t.x, t.y, t.z), DQuat::from_xyzw(q.i, q.j, q.k, q.w))
}
