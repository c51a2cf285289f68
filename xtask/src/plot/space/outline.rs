//! Convex outlines on the panel: hull, common part, area, middle.

use nalgebra::{Point2, Point3};

/// Points nearer to each other than this are one, pixels.
const SAME: f64 = 1e-3;
/// A corner that spans less than this with its neighbours, square pixels, is none: no picture hangs on rounding.
const STRAIGHT: f64 = 1e-3;

/// The corners of the convex hull as seen, in order, turning from x to y; depth is carried along.
pub(super) fn hull(mut points: Vec<Point3<f64>>) -> Vec<Point3<f64>> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup_by(|a, b| (a.xy() - b.xy()).norm() < SAME);
    if points.len() < 3 {
        return points;
    }
    let mut corners = half(points.iter());
    let back = half(points.iter().rev());
    corners.pop();
    corners.extend(&back[..back.len() - 1]);
    corners
}

/// One side of the hull of sorted points.
fn half<'p>(points: impl Iterator<Item = &'p Point3<f64>>) -> Vec<Point3<f64>> {
    let mut corners: Vec<Point3<f64>> = Vec::new();
    for point in points {
        while let [.., a, b] = corners[..]
            && (b.xy() - a.xy()).perp(&(point.xy() - b.xy())) <= STRAIGHT
        {
            corners.pop();
        }
        corners.push(*point);
    }
    corners
}

/// Twice the area, positive for what turns as hulls do.
fn doubled_area(outline: &[Point2<f64>]) -> f64 {
    edges(outline).map(|[a, b]| a.coords.perp(&b.coords)).sum()
}

/// Area in square pixels.
pub(super) fn area(outline: &[Point2<f64>]) -> f64 {
    doubled_area(outline).abs() / 2.0
}

/// The middle of the corners, which is inside.
pub(super) fn middle(outline: &[Point2<f64>]) -> Point2<f64> {
    let sum: nalgebra::Vector2<f64> = outline.iter().map(|point| point.coords).sum();
    Point2::from(sum / outline.len() as f64)
}

/// Each corner with the next.
pub(super) fn edges<P: Copy>(outline: &[P]) -> impl Iterator<Item = [P; 2]> {
    outline.iter().zip(outline.iter().cycle().skip(1)).map(|(&a, &b)| [a, b])
}

/// What of a convex outline is within another, which turns as hulls do; empty where they are apart.
pub(super) fn common(outline: &[Point2<f64>], within: &[Point2<f64>]) -> Vec<Point2<f64>> {
    edges(within).fold(outline.to_vec(), |rest, [a, b]| {
        let side = |p: &Point2<f64>| (b - a).perp(&(p - a));
        let mut kept = Vec::with_capacity(rest.len() + 1);
        for [p, q] in edges(&rest) {
            let (at_p, at_q) = (side(&p), side(&q));
            if at_p >= 0.0 {
                kept.push(p);
            }
            if (at_p > 0.0 && at_q < 0.0) || (at_p < 0.0 && at_q > 0.0) {
                kept.push(p + (q - p) * (at_p / (at_p - at_q)));
            }
        }
        kept
    })
}

/// What of the line between two points is within a convex outline that turns as hulls do.
pub(super) fn inside([a, b]: [Point2<f64>; 2], within: &[Point2<f64>]) -> Option<[Point2<f64>; 2]> {
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for [p, q] in edges(within) {
        let (at_a, at_b) = ((q - p).perp(&(a - p)), (q - p).perp(&(b - p)));
        if at_a < 0.0 && at_b < 0.0 {
            return None;
        }
        if at_a < 0.0 {
            from = from.max(at_a / (at_a - at_b));
        } else if at_b < 0.0 {
            to = to.min(at_a / (at_a - at_b));
        }
    }
    (from < to).then(|| [a + (b - a) * from, a + (b - a) * to])
}

/// Whether a point is inside a convex outline that turns as hulls do.
#[cfg(test)]
pub(super) fn holds(outline: &[Point2<f64>], point: &Point2<f64>) -> bool {
    edges(outline).all(|[a, b]| (b - a).perp(&(point - a)) >= -1e-9)
}

#[cfg(test)]
mod tests {
    use proptest::{collection::vec, prelude::*};

    use super::*;

    fn points(n: impl Into<proptest::collection::SizeRange>) -> impl Strategy<Value = Vec<Point3<f64>>> {
        vec((-50.0..50.0, -50.0..50.0, -50.0..50.0).prop_map(|(x, y, z)| Point3::new(x, y, z)), n)
    }

    fn flat(points: &[Point3<f64>]) -> Vec<Point2<f64>> {
        points.iter().map(Point3::xy).collect()
    }

    proptest! {
        #[test]
        fn a_hull_is_convex_and_holds_all_its_points(points in points(3..40)) {
            let corners = flat(&hull(points.clone()));
            for ([a, b], [_, c]) in edges(&corners).zip(edges(&corners).skip(1)) {
                prop_assert!((b - a).perp(&(c - b)) > 0.0);
            }
            for point in points {
                let outside = |[a, b]: [Point2<f64>; 2]| -(b - a).perp(&(point.xy() - a)) / (b - a).norm();
                prop_assert!(edges(&corners).all(|edge| outside(edge) < 0.01));
            }
        }

        #[test]
        fn the_common_part_is_in_both_whichever_comes_first(a in points(3..12), b in points(3..12)) {
            let [a, b] = [flat(&hull(a)), flat(&hull(b))];
            let (ab, ba) = (common(&a, &b), common(&b, &a));
            prop_assert!((area(&ab) - area(&ba)).abs() < 1e-6);
            for point in ab {
                prop_assert!(edges(&a).chain(edges(&b)).all(|[p, q]| (q - p).perp(&(point - p)) > -1e-6));
            }
        }

        #[test]
        fn a_line_is_cut_where_it_leaves(outline in points(3..12), ends in points(2)) {
            let outline = flat(&hull(outline));
            let ends = [ends[0].xy(), ends[1].xy()];
            let length = inside(ends, &outline).map_or(0.0, |[a, b]| (b - a).norm());
            let n = 2000;
            let hits = (0..n).filter(|&i| holds(&outline, &(ends[0] + (ends[1] - ends[0]) * (f64::from(i) + 0.5) / f64::from(n))));
            let counted = hits.count() as f64 / f64::from(n) * (ends[1] - ends[0]).norm();
            prop_assert!((length - counted).abs() < 0.2);
        }
    }
}
