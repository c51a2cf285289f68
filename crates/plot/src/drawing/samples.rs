//! Samples of lines and arrows before their names in the legend. The plotting crate draws a line there, too short for
//! dashes and without an arrowhead.

use kuva::render::render::{Primitive, Scene};

use crate::drawing::elements::{area, arrowhead};

/// Pixels from the sample's ends to the name.
const FROM: f64 = 26.0;
const TO: f64 = 4.0;

/// Length and half width of a head, pixels.
const HEAD: (f64, f64) = (8.0, 3.6);

/// The kind of thing that a name denotes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Sample {
    Line,
    Arrow,
}

/// Redraws the samples before these names.
pub(crate) fn draw(names: &[(&str, Sample)], scene: &mut Scene) {
    let mut drawn = Vec::with_capacity(scene.elements.len());
    let mut named = None;
    for mut element in std::mem::take(&mut scene.elements) {
        let mut head = None;
        if let (Primitive::Line { x1, x2, y1, stroke, .. }, Some((name_at, sample))) = (&mut element, named.take()) {
            (*x1, *x2) = (name_at - FROM, name_at - TO);
            if sample == Sample::Arrow {
                let (foot, [tip, below, above]) = arrowhead((*x1, *y1), (*x2, *y1), HEAD.0, HEAD.1);
                head = Some(area(&[tip, above, below], stroke.clone()));
                *x2 = foot.0;
            }
        }
        if let Primitive::Text { x, content, .. } = &element {
            named = names.iter().find(|(name, _)| name == content).map(|(_, sample)| (*x, *sample));
        }
        drawn.extend([Some(element), head].into_iter().flatten());
    }
    scene.elements = drawn;
}
