//! The scale of what is shown in colours: its name above it, without which the plotting crate leaves it, and its colours as
//! light or dark as those that it is of.

use kuva::render::color::Color;
use kuva::render::render::{Primitive, Scene, TextAnchor};

use crate::Sketch;
use crate::drawing::elements::words;

/// Pixels from the scale to its name's foot, and the name's size.
const GAP: f64 = 8.0;
const SIZE: u32 = 14;

/// Completes the scale of a scene that has one: bars without outline, then the last outline without filling.
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
