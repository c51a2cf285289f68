use nalgebra::Point3;

/// A mesh file as the caller's resolver returns it. Vertices in the file's own unit; the URDF's scale is applied later.
#[derive(Debug, Clone, PartialEq)]
pub enum MeshShape {
    /// The triangles as a hollow surface; a shape wholly inside does not touch it.
    Surface {
        /// Vertices.
        vertices: Vec<Point3<f64>>,
        /// Three indices into `vertices` per triangle.
        triangles: Vec<[u32; 3]>,
    },
    /// The convex hull of points: solid and much faster, but larger than a concave mesh.
    ConvexHull {
        /// The points, in any order.
        vertices: Vec<Point3<f64>>,
    },
    /// No shape: the mesh is deliberately excluded from collision.
    LeftOut,
}
