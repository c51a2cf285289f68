//! Words of a scene, and the lines and areas that the plotting crate draws for it.

use std::fmt::Write as _;

use kuva::render::color::Color;
use kuva::render::render::{PathData, Primitive, Scene, TextAnchor};
use nalgebra::Point2;

use super::item::{DISC, WORDS};
use super::view::View;
use super::{Item, legend, shade};

/// Notes farther than this from their point have a line to it, pixels.
const FAR: f64 = 14.0;

/// Draws the words of an item.
pub(super) fn draw(item: &Item, view: &View, scene: &mut Scene) {
    match item {
        Item::Note { at, text, shift, color } => {
            let at = view.place(at).xy();
            let to = Point2::new(at.x + shift.0, at.y + shift.1);
            if shift.0.hypot(shift.1) > FAR {
                scene.add(polyline(&[at, to], Color::from(*color), 0.8));
            }
            let (gap, anchor) = match shift.0 {
                0.0 => (0.0, TextAnchor::Middle),
                right if right < 0.0 => (-3.0, TextAnchor::End),
                _ => (3.0, TextAnchor::Start),
            };
            scene.add(legend::text((to.x + gap, to.y + 4.0), text, anchor, color, None));
        }
        Item::Mark { at, text, color } => {
            let at = view.place(at).xy();
            scene.add(disc(&at, DISC, Color::from(*color), Some(Color::from("#ffffff"))));
            let foot = (at.x, at.y + 0.36 * f64::from(WORDS));
            scene.add(legend::text(foot, text, TextAnchor::Middle, shade::word_on(color), None));
        }
        _ => {}
    }
}

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
