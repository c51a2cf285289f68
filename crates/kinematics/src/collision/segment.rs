use nalgebra::{Point3, Vector3};

/// A capsule: all points within `radius` of the segment from `ends[0]` to `ends[1]`. A sphere is a capsule without
/// length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Capsule {
    pub(super) ends: [Point3<f64>; 2],
    pub(super) radius: f64,
}

impl Capsule {
    /// Distance between the two surfaces; negative if they overlap, down to minus the sum of the radii if the axes
    /// touch.
    pub(super) fn distance(&self, other: &Self) -> f64 {
        segment_distance(self.ends, other.ends) - self.radius - other.radius
    }
}

/// The distance between two segments: the smallest of the distances of the four ends to the other segment and, if its
/// feet lie inside both, the common perpendicular. Every candidate is a distance between two points of the segments,
/// so that rounding, above all for parallel segments, never gives less than the true distance.
fn segment_distance([a, b]: [Point3<f64>; 2], [c, d]: [Point3<f64>; 2]) -> f64 {
    let (u, v, w) = (b - a, d - c, a - c);
    let ends = [to_segment(a, c, v), to_segment(b, c, v), to_segment(c, a, u), to_segment(d, a, u)];
    let nearest = ends.into_iter().fold(f64::INFINITY, f64::min);
    let (uu, uv, vv, uw, vw) = (u.dot(&u), u.dot(&v), v.dot(&v), u.dot(&w), v.dot(&w));
    let determinant = uu * vv - uv * uv;
    let (s, t) = ((uv * vw - vv * uw) / determinant, (uu * vw - uv * uw) / determinant);
    let inside = (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t);
    if inside { nearest.min((w + u * s - v * t).norm()) } else { nearest }
}

/// The distance from a point to the segment with vector `along` from `start`.
fn to_segment(point: Point3<f64>, start: Point3<f64>, along: Vector3<f64>) -> f64 {
    let offset = point - start;
    let length = along.norm_squared();
    let part = if length > 0.0 { (offset.dot(&along) / length).clamp(0.0, 1.0) } else { 0.0 };
    (offset - along * part).norm()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn point() -> impl Strategy<Value = Point3<f64>> {
        [-1.0..1.0, -1.0..1.0, -1.0..1.0_f64].prop_map(Point3::from)
    }

    /// The distance between the points at the parameters s, t of the two segments, minimised over t for every s in
    /// closed form, and over s by golden-section search: the distance is convex.
    fn by_search([a, b]: [Point3<f64>; 2], [c, d]: [Point3<f64>; 2]) -> f64 {
        let at = |s: f64| to_segment(a + (b - a) * s, c, d - c);
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..200 {
            let (left, right) = (low + (high - low) * 0.382, low + (high - low) * 0.618);
            if at(left) < at(right) { high = right } else { low = left }
        }
        at(f64::midpoint(low, high))
    }

    proptest! {
        #[test]
        fn equals_a_search(p in [point(), point()], q in [point(), point()], shrunk in 0.0..1.0_f64, parallel in 0..3) {
            let mut q = q;
            match parallel {
                0 => q[1] = q[0] + (p[1] - p[0]) * shrunk,
                1 => q[1] = q[0],
                _ => {}
            }
            let found = segment_distance(p, q);
            prop_assert!((found - by_search(p, q)).abs() < 1e-7, "{} {}", found, by_search(p, q));
            prop_assert!((found - segment_distance([q[1], q[0]], p)).abs() < 1e-12);
        }
    }

    #[test]
    fn known_distances() {
        let segment = |a: [f64; 3], b: [f64; 3]| [Point3::from(a), Point3::from(b)];
        let x = segment([0.0; 3], [1.0, 0.0, 0.0]);
        for (other, distance) in [
            (segment([0.5, -1.0, 0.3], [0.5, 1.0, 0.3]), 0.3),
            (segment([0.2, 0.0, 0.1], [5.0, 0.0, 0.1]), 0.1),
            (segment([2.0, 0.0, 0.0], [3.0, 0.0, 0.0]), 1.0),
            (segment([0.4, 0.0, 0.0], [0.4, 0.0, 0.0]), 0.0),
            (segment([1.0, 1.0, 1e-3], [1.0, 1.001, 1e-3]), 1.0_f64.hypot(1e-3)),
        ] {
            assert!((segment_distance(x, other) - distance).abs() < 1e-15, "{other:?}");
        }
        let capsule = |ends, radius| Capsule { ends, radius };
        let skins = capsule(x, 0.2).distance(&capsule(segment([0.5, -1.0, 0.3], [0.5, 1.0, 0.3]), 0.15));
        assert!((skins + 0.05).abs() < 1e-15);
    }
}
