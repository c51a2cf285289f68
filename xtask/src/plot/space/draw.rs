//! Pieces and words as the plotting crate's lines, areas and texts.

use std::fmt::Write as _;

use kuva::render::color::Color;
use kuva::render::render::{PathData, Primitive, Scene, TextAnchor};
use nalgebra::Point2;

use super::body::Fill;
use super::item::{DISC, WORDS};
use super::pieces::{Look, Piece};
use super::view::View;
use super::{Item, legend, shade};

/// Width of outlines, pixels.
const INK: f64 = 0.9;
/// Notes farther than this from their point have a line to it, pixels.
const FAR: f64 = 14.0;

/// Draws pieces in this order; pieces of a stroke that follow each other become one line.
pub(super) fn pieces(pieces: &[Piece], scene: &mut Scene) {
    let mut rest = pieces;
    while let [piece, after @ ..] = rest {
        rest = after;
        match &piece.look {
            Look::Stroke { stroke, place, ends, style } => {
                let mut line = ends.to_vec();
                let mut last = *place;
                while let [Piece { look: Look::Stroke { stroke: same, place, ends, .. }, .. }, after @ ..] = rest
                    && (*same, *place) == (*stroke, last + 1)
                {
                    line.push(ends[1]);
                    (last, rest) = (*place, after);
                }
                scene.add(polyline(&line, Color::from(style.color), style.width));
            }
            Look::Dot { centre, radius, color } => scene.add(disc(centre, *radius, Color::from(*color), None)),
            Look::Body { fills, lines, opacity, ink } => {
                fills.iter().filter(|fill| fill.outline.len() > 2).for_each(|fill| scene.add(area(fill, *opacity)));
                for line in joined(lines) {
                    scene.add(polyline(&line, ink.clone(), INK));
                }
            }
        }
    }
}

/// Draws the words of an item.
pub(super) fn words(item: &Item, view: &View, scene: &mut Scene) {
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
pub(super) fn area(fill: &Fill, opacity: f64) -> Primitive {
    let mut d = String::new();
    for (i, point) in fill.outline.iter().enumerate() {
        let command = if i == 0 { 'M' } else { 'L' };
        let _ = write!(d, "{command}{:.2} {:.2}", point.x, point.y);
    }
    Primitive::Path(Box::new(PathData {
        d: d + "Z",
        fill: Some(fill.color.clone()),
        stroke: Color::None,
        stroke_width: 0.0,
        opacity: (opacity < 1.0).then_some(opacity),
        stroke_dasharray: None,
    }))
}

fn disc(centre: &Point2<f64>, r: f64, fill: Color, stroke: Option<Color>) -> Primitive {
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

/// Lines that follow each other as one.
fn joined(lines: &[[Point2<f64>; 2]]) -> Vec<Vec<Point2<f64>>> {
    let mut joined: Vec<Vec<Point2<f64>>> = vec![];
    for [a, b] in lines {
        match joined.last_mut() {
            Some(line) if line.last() == Some(a) => line.push(*b),
            _ => joined.push(vec![*a, *b]),
        }
    }
    joined
}
