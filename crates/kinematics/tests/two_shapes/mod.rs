//! Two shapes that slide past each other, and meshes for them.
use kinematics::{MeshShape, RobotModel};
use nalgebra::Point3;

/// Link "a" with one shape, link "b" with another; "b" slides along x, past a link without a shape.
pub(crate) fn two_shapes(first: &str, second: &str) -> RobotModel {
    let collision = |shape: &str| format!("<collision><geometry>{shape}</geometry></collision>");
    RobotModel::from_urdf(&format!(
        r#"<robot name="r"><link name="a">{}</link><link name="between"/><link name="b">{}</link>
           <joint name="j" type="prismatic"><parent link="a"/><child link="between"/><axis xyz="1 0 0"/>
             <limit lower="-9" upper="9"/></joint>
           <joint name="k" type="prismatic"><parent link="between"/><child link="b"/><axis xyz="0 1 0"/>
             <limit lower="-9" upper="9"/></joint></robot>"#,
        collision(first),
        collision(second),
    ))
    .unwrap()
}

/// A cube with half edge 1, as triangles.
fn cube() -> (Vec<Point3<f64>>, Vec<[u32; 3]>) {
    let corner = |i: u32| Point3::from([i & 1, (i >> 1) & 1, i >> 2].map(|bit| 2.0 * f64::from(bit) - 1.0));
    let squares = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    ((0..8).map(corner).collect(), squares.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect())
}

pub(crate) fn resolver(filename: &str) -> Option<MeshShape> {
    let (vertices, triangles) = cube();
    match filename {
        "surface" => Some(MeshShape::Surface { vertices, triangles }),
        "hull" => Some(MeshShape::ConvexHull { vertices }),
        "left out" => Some(MeshShape::LeftOut),
        "flat" => Some(MeshShape::ConvexHull { vertices: vertices[..2].to_vec() }),
        "no such vertex" => Some(MeshShape::Surface { vertices, triangles: vec![[0, 1, 99]] }),
        _ => None,
    }
}
