//! Capsules and spheres among a link's shapes.

use nalgebra::Point3;

use super::segment::Capsule;
use crate::{CollisionShape, Geometry};

/// Cylinder ends and sphere centres within this distance, in metres, coincide.
const SAME_POINT: f64 = 1e-9;

/// The shapes, with each cylinder between two spheres of equal radius replaced by a capsule: fewer shapes, and
/// distances in closed form.
pub(super) fn whole_capsules(shapes: &[&CollisionShape]) -> Vec<CollisionShape> {
    let mut shapes: Vec<CollisionShape> = shapes.iter().map(|&shape| shape.clone()).collect();
    while let Some((cylinder, caps)) = (0..shapes.len()).find_map(|at| Some((at, caps(&shapes, at)?))) {
        if let Geometry::Cylinder { radius, length } = shapes[cylinder].geometry {
            shapes[cylinder].geometry = Geometry::Capsule { radius, length };
        }
        let mut place = 0..;
        shapes.retain(|_| place.next().is_some_and(|place| !caps.contains(&place)));
    }
    shapes
}

/// Indices of the two spheres that round a cylinder's ends.
fn caps(shapes: &[CollisionShape], cylinder: usize) -> Option<[usize; 2]> {
    let Geometry::Cylinder { radius, length } = shapes[cylinder].geometry else { return None };
    let cap = |end| shapes.iter().position(|shape| is_sphere(shape, end, radius));
    let [first, second] = ends(&shapes[cylinder], length);
    Some([cap(first)?, cap(second)?])
}

fn is_sphere(shape: &CollisionShape, centre: Point3<f64>, of_radius: f64) -> bool {
    let at_centre = (shape.origin.translation.vector - centre.coords).norm() <= SAME_POINT;
    matches!(shape.geometry, Geometry::Sphere { radius } if (radius - of_radius).abs() <= SAME_POINT) && at_centre
}

/// A capsule or sphere as a [`Capsule`] in the link's frame.
pub(super) fn as_capsule(shape: &CollisionShape) -> Option<Capsule> {
    match shape.geometry {
        Geometry::Capsule { radius, length } => Some(Capsule { ends: ends(shape, length), radius }),
        Geometry::Sphere { radius } => Some(Capsule { ends: ends(shape, 0.0), radius }),
        _ => None,
    }
}

fn ends(shape: &CollisionShape, length: f64) -> [Point3<f64>; 2] {
    [-0.5, 0.5].map(|part| shape.origin * Point3::new(0.0, 0.0, part * length))
}
