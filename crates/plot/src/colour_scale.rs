//! The name of what a scale of colours shows, above it: the plotting crate leaves it without one.

use kuva::render::color::Color;
use kuva::render::render::{Primitive, Scene, TextAnchor};

/// Pixels from the scale to its name's foot, and the name's size.
const GAP: f64 = 8.0;
const SIZE: u32 = 14;

/// Writes a name above the scale of a scene that has one: the last outline without filling.
pub(crate) fn name(name: &str, scene: &mut Scene) {
    let middle_of_top = |element: &Primitive| match element {
        Primitive::Rect { x, y, width, fill: Color::None, stroke: Some(_), .. } => Some((x + width / 2.0, *y)),
        _ => None,
    };
    if let Some((x, y)) = scene.elements.iter().rev().find_map(middle_of_top) {
        let (content, anchor) = (name.to_owned(), TextAnchor::Middle);
        scene.add(Primitive::Text {
            x,
            y: y - GAP,
            content,
            size: SIZE,
            anchor,
            rotate: None,
            bold: false,
            color: None,
        });
    }
}
