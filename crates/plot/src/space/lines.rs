//! Lines, areas and discs that the plotting crate draws.

use std::fmt::Write as _;

use kuva::render::color::Color;
use kuva::render::render::{PathData, Primitive};
use nalgebra::Point2;

/// A line through points of the panel.
pub(super) fn polyline(points: &[Point2<f64>], stroke: Color, stroke_width: f64) -> Primitive {
    let points = points.iter().map(|point| (point.x, point.y)).collect();
    Primitive::PolyLine { points, stroke, stroke_width, stroke_dasharray: None }
}

/// An area of the panel without an outline.
pub(super) fn area(corners: &[Point2<f64>], fill: Color) -> Primitive {
    let mut d = String::new();
    for (i, point) in corners.iter().enumerate() {
        let command = if i == 0 { 'M' } else { 'L' };
        let _ = write!(d, "{command}{:.2} {:.2}", point.x, point.y);
    }
    Primitive::Path(Box::new(PathData {
        d: d + "Z",
        fill: Some(fill),
        stroke: Color::None,
        stroke_width: 0.0,
        opacity: None,
        stroke_dasharray: None,
    }))
}

/// A disc, with an edge where that has a colour.
pub(super) fn disc(centre: &Point2<f64>, r: f64, fill: Color, stroke: Option<Color>) -> Primitive {
    Primitive::Circle {
        cx: centre.x,
        cy: centre.y,
        r,
        fill,
        fill_opacity: None,
        stroke_width: stroke.as_ref().map(|_| 1.0),
        stroke,
    }
}
