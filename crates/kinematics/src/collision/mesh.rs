use nalgebra::Point3;

/// A mesh file as the caller's resolver returns it. Vertices in the file's own unit; the URDF's scale is applied later.
#[derive(Debug, Clone, PartialEq)]
pub enum MeshShape {
    /// The triangles themselves: hollow, so that a shape wholly inside touches nothing.
    Surface {
        /// Corners.
        vertices: Vec<Point3<f64>>,
        /// Three places in `vertices` each.
        triangles: Vec<[u32; 3]>,
    },
    /// The convex hull of points: solid and much faster, larger than a mesh with hollows.
    ConvexHull {
        /// The points, in any order.
        vertices: Vec<Point3<f64>>,
    },
    /// Nothing: this mesh takes no part in collision, on purpose.
    LeftOut,
}
