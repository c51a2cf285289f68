//! Lines, arrows and dots, as far as bodies do not hide them.

use kuva::render::color::Color;
use kuva::render::render::Scene;
use nalgebra::{Point2, Point3};

use super::cast::{Body, seen};
use super::item::Item;
use super::shade::{Rgb, color, rgb};
use super::view::View;
use crate::drawing::dashes::dashed;
use crate::drawing::elements::{area, arrowhead, disc, polyline};
use crate::{Dash, Stroke};

/// Distance between the points at which visibility is tested, pixels.
const STEP: f64 = 1.5;
/// Largest number of these points per line.
const STEPS: f64 = 1e5;
/// Items on a surface are moved towards the viewer by this many pixels.
const LIFT: f64 = 0.75;
/// Points closer than this to the line between their neighbours are omitted, pixels.
const STRAIGHT: f64 = 0.08;

/// Draws an item that is neither a body nor a text.
pub(super) fn draw(item: &Item, bodies: &[Body], view: &View, scene: &mut Scene) {
    match item {
        Item::Path { points, stroke, .. } => {
            line(&points.iter().map(|point| view.place(point)).collect::<Vec<_>>(), stroke, bodies, scene);
        }
        Item::Arrow { from, to, stroke } => arrow(view.place(from), view.place(to), stroke, bodies, scene),
        Item::Dots { points, color, radius } => {
            for at in points.iter().map(|point| view.place(point)) {
                if let Some(color) = seen(rgb(color), &at.xy(), at.z + LIFT, bodies) {
                    scene.add(disc(&at.xy(), *radius, self::color(color), None));
                }
            }
        }
        _ => {}
    }
}

/// A line through points of the panel, with its dashes, interrupted where a point is not finite.
pub(super) fn line(points: &[Point3<f64>], style: &Stroke, bodies: &[Body], scene: &mut Scene) {
    for points in points.split(|point| !point.iter().all(|value| value.is_finite())) {
        for dash in dashed(&straightened(points), &pattern(style)) {
            for (points, color) in visible(&dash, rgb(style.color), bodies) {
                scene.add(polyline(&points, color, style.width));
            }
        }
    }
}

/// The visible parts of a line, with their colours.
fn visible(points: &[Point3<f64>], color: Rgb, bodies: &[Body]) -> Vec<(Vec<Point2<f64>>, Color)> {
    let mut parts: Vec<(Vec<Point2<f64>>, Option<Rgb>)> = vec![];
    for pair in points.windows(2) {
        let (from, along) = (pair[0], pair[1] - pair[0]);
        let steps = if bodies.is_empty() { 1 } else { (along.xy().norm() / STEP).ceil().clamp(1.0, STEPS) as usize };
        let at = |step: f64| from + along * (step / steps as f64);
        for step in 0..steps {
            let (middle, end) = (at(step as f64 + 0.5), at(step as f64 + 1.0).xy());
            let color = seen(color, &middle.xy(), middle.z + LIFT, bodies);
            match parts.last_mut() {
                Some((part, same)) if *same == color => part.push(end),
                _ => parts.push((vec![at(step as f64).xy(), end], color)),
            }
        }
    }
    parts.into_iter().filter_map(|(part, color)| Some((straight(&part), self::color(color?)))).collect()
}

/// A line with a flat arrowhead, turned towards the viewer.
fn arrow(from: Point3<f64>, to: Point3<f64>, style: &Stroke, bodies: &[Body], scene: &mut Scene) {
    let length = (to.xy() - from.xy()).norm();
    if length < 1.0 {
        return;
    }
    let head = head(style).min(0.6 * length);
    let foot = to - (to - from) * (head / length);
    line(&[from, foot], style, bodies, scene);
    let middle = nalgebra::center(&foot, &to);
    if let Some(color) = seen(rgb(style.color), &middle.xy(), middle.z + LIFT, bodies) {
        let (_, corners) = arrowhead((from.x, from.y), (to.x, to.y), head, 0.38 * head);
        scene.add(area(&corners, self::color(color)));
        let corners = corners.map(|(x, y)| Point2::new(x, y));
        scene.add(polyline(&[corners[0], corners[1], corners[2], corners[0]], self::color(color), 0.9));
    }
}

/// Length of an arrow's head, pixels.
pub(super) fn head(stroke: &Stroke) -> f64 {
    4.0 + 2.5 * stroke.width
}

/// Lengths of dashes and of the gaps after them, pixels. Dashes have round ends, which extend them by half a width.
fn pattern(stroke: &Stroke) -> Vec<f64> {
    let lengths: &[f64] = match stroke.dash {
        Dash::Solid => &[],
        Dash::Dashed => &[4.0, 3.2],
        Dash::Dotted => &[0.05, 2.4],
    };
    lengths.iter().map(|length| length * stroke.width.max(1.0)).collect()
}

/// The points without those on the straight line between others.
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

/// The same for points of the panel.
fn straight(points: &[Point2<f64>]) -> Vec<Point2<f64>> {
    let level: Vec<_> = points.iter().map(|point| Point3::new(point.x, point.y, 0.0)).collect();
    straightened(&level).iter().map(Point3::xy).collect()
}
