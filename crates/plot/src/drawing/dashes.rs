//! Splits dashed lines into their dashes.

use kuva::render::render::Primitive;
use nalgebra::Point3;

/// An element of a scene, prepared for pixels. There the plotting crate restarts its dashes at each point of a line, which
/// leaves none if points are close.
pub(crate) fn drawn(element: &Primitive) -> Vec<Primitive> {
    let (points, stroke, stroke_width, pattern) = match element {
        Primitive::PolyLine { points, stroke, stroke_width, stroke_dasharray: Some(pattern) } => {
            (points.clone(), stroke, stroke_width, pattern)
        }
        Primitive::Line { x1, y1, x2, y2, stroke, stroke_width, stroke_dasharray: Some(pattern) } => {
            (vec![(*x1, *y1), (*x2, *y2)], stroke, stroke_width, pattern)
        }
        _ => return vec![element.clone()],
    };
    let pattern: Vec<f64> = pattern.split(' ').filter_map(|length| length.parse().ok()).collect();
    let points: Vec<_> = points.iter().map(|&(x, y)| Point3::new(x, y, 0.0)).collect();
    let solid = |dash: Vec<Point3<f64>>| Primitive::PolyLine {
        points: dash.iter().map(|point| (point.x, point.y)).collect(),
        stroke: stroke.clone(),
        stroke_width: *stroke_width,
        stroke_dasharray: None,
    };
    dashed(&points, &pattern).into_iter().map(solid).collect()
}

/// Farther out, pixels, no dash is visible, and the dashes of a line to there would exceed the memory.
const OUTSIDE: f64 = 1e5;

/// The parts of a line that a pattern draws, with lengths measured on the panel. A line that leads far outside is solid.
pub(crate) fn dashed(points: &[Point3<f64>], pattern: &[f64]) -> Vec<Vec<Point3<f64>>> {
    let near = |point: &Point3<f64>| point.x.abs() < OUTSIDE && point.y.abs() < OUTSIDE;
    if pattern.is_empty() || !points.iter().all(near) {
        return vec![points.to_vec()];
    }
    let Some(&first) = points.first() else { return vec![] };
    let mut dashes = vec![vec![first]];
    let (mut part, mut left) = (0, pattern[0]);
    for pair in points.windows(2) {
        let (mut from, to) = (pair[0], pair[1]);
        let mut length = (to.xy() - from.xy()).norm();
        while length > left {
            from += (to - from) * (left / length);
            length -= left;
            part = (part + 1) % pattern.len();
            left = pattern[part];
            if part % 2 == 0 {
                dashes.push(vec![from]);
            } else if let Some(dash) = dashes.last_mut() {
                dash.push(from);
            }
        }
        left -= length;
        if part % 2 == 0
            && let Some(dash) = dashes.last_mut()
        {
            dash.push(to);
        }
    }
    dashes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dashes_go_on_from_point_to_point() {
        // A line of length twelve, with points at unit distance.
        let points: Vec<(f64, f64)> = (0..=12).map(|x| (f64::from(x), 5.0)).collect();
        let line = Primitive::PolyLine {
            points,
            stroke: "#000000".into(),
            stroke_width: 1.0,
            stroke_dasharray: Some("3 1.5".to_owned()),
        };
        let ends: Vec<_> = drawn(&line)
            .iter()
            .map(|dash| match dash {
                Primitive::PolyLine { points, stroke_dasharray: None, .. } => [points[0], points[points.len() - 1]],
                _ => panic!("{dash:?} is no solid line"),
            })
            .collect();
        assert_eq!(ends, [[(0.0, 5.0), (3.0, 5.0)], [(4.5, 5.0), (7.5, 5.0)], [(9.0, 5.0), (12.0, 5.0)]]);
    }

    #[test]
    fn lines_without_points_or_far_outside_end() {
        assert!(dashed(&[], &[3.0, 1.5]).is_empty());
        for far in [1e12, f64::INFINITY, f64::NAN] {
            let line = [Point3::origin(), Point3::new(far, 0.0, 0.0)];
            assert_eq!(dashed(&line, &[3.0, 1.5]).len(), 1);
        }
    }
}
