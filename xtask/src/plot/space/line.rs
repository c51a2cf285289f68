//! Strokes: dashes, and pieces short enough to be put in order.

use nalgebra::Point3;

use super::super::dashes::dashed;
use super::super::{Dash, Stroke};
use super::body::Slab;

/// Longest piece, pixels.
const LONGEST: f64 = 16.0;
/// Points this near to the line between their neighbours are left out, pixels.
const STRAIGHT: f64 = 0.08;

/// Length of an arrow's head, pixels.
pub(super) fn head(stroke: &Stroke) -> f64 {
    4.0 + 2.5 * stroke.width
}

/// The strokes of a line in its dashes, each a row of short pieces that end at every plate they pass through.
pub(super) fn pieces(points: &[Point3<f64>], stroke: &Stroke, slabs: &[Slab]) -> Vec<Vec<Point3<f64>>> {
    let dashes = dashed(&straightened(points), &pattern(stroke));
    dashes.iter().map(|dash| shortened(dash, slabs)).collect()
}

/// Lengths of dashes and of the gaps after them, pixels. Their ends are round, and half a width longer.
fn pattern(stroke: &Stroke) -> Vec<f64> {
    let lengths: &[f64] = match stroke.dash {
        Dash::Solid => &[],
        Dash::Dashed => &[4.0, 3.2],
        Dash::Dotted => &[0.05, 2.4],
    };
    lengths.iter().map(|length| length * stroke.width.max(1.0)).collect()
}

/// Without the points that lie on the line between others.
fn straightened(points: &[Point3<f64>]) -> Vec<Point3<f64>> {
    let (Some(&first), Some(&last)) = (points.first(), points.last()) else { return vec![] };
    let along = (last - first).try_normalize(1e-12).unwrap_or_default();
    let off = |point: &Point3<f64>| {
        let from = point - first;
        (from - along * from.dot(&along).clamp(0.0, (last - first).norm())).norm()
    };
    let farthest = (0..points.len()).max_by(|&a, &b| off(&points[a]).total_cmp(&off(&points[b])));
    match farthest {
        Some(at) if off(&points[at]) > STRAIGHT => {
            let mut line = straightened(&points[..=at]);
            line.pop();
            line.extend(straightened(&points[at..]));
            line
        }
        _ => vec![first, last],
    }
}

/// With points in between, so that no piece is long or passes through a plate.
fn shortened(points: &[Point3<f64>], slabs: &[Slab]) -> Vec<Point3<f64>> {
    let mut line = points[..1].to_vec();
    for pair in points.windows(2) {
        let (from, along) = (pair[0], pair[1] - pair[0]);
        let n = (along.norm() / LONGEST).ceil().max(1.0);
        let mut stops: Vec<f64> = (1..=n as usize).map(|i| i as f64 / n).collect();
        let crossings = slabs.iter().filter_map(|slab| slab.crossing(&[pair[0], pair[1]]));
        stops.extend(crossings.map(|point| (point - from).norm() / along.norm()));
        stops.sort_by(f64::total_cmp);
        stops.dedup_by(|a, b| *a - *b < 1e-9);
        line.extend(stops.into_iter().map(|stop| from + along * stop));
    }
    line
}
