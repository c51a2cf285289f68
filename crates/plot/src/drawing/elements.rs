//! Elements of the plotting crate, without their unused attributes.

use std::fmt::Write as _;

use kuva::render::color::Color;
use kuva::render::render::{PathData, Primitive, TextAnchor};

/// A position, pixels.
type Place = (f64, f64);

/// A straight line.
pub(crate) fn line(from: Place, to: Place, stroke: Color, stroke_width: f64) -> Primitive {
    Primitive::Line { x1: from.0, y1: from.1, x2: to.0, y2: to.1, stroke, stroke_width, stroke_dasharray: None }
}

/// A line through points.
#[cfg(feature = "space")]
pub(crate) fn polyline(points: &[nalgebra::Point2<f64>], stroke: Color, stroke_width: f64) -> Primitive {
    let points = points.iter().map(|point| (point.x, point.y)).collect();
    Primitive::PolyLine { points, stroke, stroke_width, stroke_dasharray: None }
}

/// An area without an outline.
pub(crate) fn area(corners: &[Place], fill: Color) -> Primitive {
    let mut d = String::new();
    for (i, (x, y)) in corners.iter().enumerate() {
        let command = if i == 0 { 'M' } else { 'L' };
        let _ = write!(d, "{command}{x:.2} {y:.2}");
    }
    let (d, fill) = (d + "Z", Some(fill));
    let (stroke, stroke_width) = (Color::None, 0.0);
    Primitive::Path(Box::new(PathData { d, fill, stroke, stroke_width, opacity: None, stroke_dasharray: None }))
}

/// The flat head at the end of an arrow, with this length and half width, pixels: its base, where the shaft ends, and its
/// corners, beginning with the tip. The arrow must not have length 0.
pub(crate) fn arrowhead(from: Place, to: Place, length: f64, half_width: f64) -> (Place, [Place; 3]) {
    let (u, v) = (to.0 - from.0, to.1 - from.1);
    let arrow = u.hypot(v);
    let (along, across) = (length / arrow, half_width / arrow);
    let foot = (to.0 - along * u, to.1 - along * v);
    (foot, [to, (foot.0 - across * v, foot.1 + across * u), (foot.0 + across * v, foot.1 - across * u)])
}

/// A rectangle without an outline, from its upper left corner.
pub(crate) fn rectangle((x, y): Place, (width, height): Place, fill: Color, opacity: f64) -> Primitive {
    Primitive::Rect { x, y, width, height, fill, stroke: None, stroke_width: None, opacity: Some(opacity) }
}

/// A disc, with an edge if that has a colour.
#[cfg(feature = "space")]
pub(crate) fn disc(centre: &nalgebra::Point2<f64>, r: f64, fill: Color, stroke: Option<Color>) -> Primitive {
    let (cx, cy, stroke_width) = (centre.x, centre.y, stroke.as_ref().map(|_| 1.0));
    Primitive::Circle { cx, cy, r, fill, fill_opacity: None, stroke_width, stroke }
}

/// Horizontal text in the default colour of text.
pub(crate) fn words((x, y): Place, text: &str, size: u32, anchor: TextAnchor) -> Primitive {
    Primitive::Text { x, y, content: text.to_owned(), size, anchor, rotate: None, bold: false, color: None }
}
