//! The scale of a field in colours: adds its name above it, for which the plotting crate leaves no place, and matches its
//! colours to those of the field.

use kuva::render::color::Color;
use kuva::render::render::{Primitive, Scene, TextAnchor};

use crate::Sketch;
use crate::drawing::elements::words;

/// Pixels from the scale to the baseline of its name, and the name's size.
const GAP: f64 = 8.0;
const SIZE: u32 = 14;

/// Completes the scale of a scene that has one. Its elements are bars without an outline, followed by an outline without a
/// filling.
pub(crate) fn complete(name: &str, scene: &mut Scene) {
    let elements = &mut scene.elements;
    let is_outline =
        |element: &Primitive| matches!(element, Primitive::Rect { fill: Color::None, stroke: Some(_), .. });
    let is_bar = |element: &Primitive| matches!(element, Primitive::Rect { stroke: None, .. });
    let Some(outline) = elements.iter().rposition(is_outline) else { return };
    let Primitive::Rect { x, y, width, .. } = elements[outline] else { return };
    let bars = elements[..outline].iter().rev().take_while(|element| is_bar(element)).count();
    elements.insert(outline, Primitive::GroupEnd);
    elements.insert(outline - bars, Sketch::backdrop());
    elements.push(words((x + width / 2.0, y - GAP), name, SIZE, TextAnchor::Middle));
}
