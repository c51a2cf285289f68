use kuva::render::color::Color;
use kuva::render::render::{Primitive, Scene, TextAnchor};

use crate::drawing::elements::{area, arrowhead, line};
use crate::sign::shape;
use crate::{Mark, Panel, Sketch, Stroke};

/// A drawing without axes. All positions are in pixels from its upper left corner.
#[derive(Debug, Clone)]
pub struct Canvas {
    /// The things; later ones are drawn on top.
    pub things: Vec<Thing>,
    /// Size in pixels.
    pub size: (f64, f64),
}

/// One thing on a [`Canvas`].
#[derive(Debug, Clone)]
pub enum Thing {
    /// A line through points.
    Line {
        /// From start to end.
        points: Vec<(f64, f64)>,
        /// Its style.
        stroke: Stroke,
    },
    /// An arrow; omitted if it would be shorter than a pixel.
    Arrow {
        /// Its start.
        from: (f64, f64),
        /// Its tip.
        to: (f64, f64),
        /// In HTML notation.
        color: &'static str,
        /// Width of the shaft.
        width: f64,
    },
    /// A mark.
    Mark {
        /// Its centre.
        at: (f64, f64),
        /// Its shape.
        mark: Mark,
        /// In HTML notation.
        color: &'static str,
        /// Half its width.
        size: f64,
    },
    /// A line of text.
    Words {
        /// The centre or the left end of its baseline.
        at: (f64, f64),
        /// The text.
        text: String,
        /// Font size.
        size: u32,
        /// Whether `at` is the centre.
        centred: bool,
        /// Whether the text is bold.
        bold: bool,
        /// In HTML notation; without one, the default colour of text.
        color: Option<&'static str>,
    },
}

impl Panel for Canvas {
    fn sketch(&self) -> Sketch {
        let mut scene = Scene::new(self.size.0, self.size.1);
        self.things.iter().flat_map(drawn).for_each(|element| scene.add(element));
        Sketch::new(scene)
    }
}

fn drawn(thing: &Thing) -> Vec<Primitive> {
    match thing.clone() {
        Thing::Line { points, stroke } => vec![Primitive::PolyLine {
            points,
            stroke: Color::from(stroke.color),
            stroke_width: stroke.width,
            stroke_dasharray: kuva::plot::LineStyle::from(stroke.dash).dasharray(),
        }],
        Thing::Arrow { from, to, color, width } => arrow(from, to, color, width),
        Thing::Mark { at, mark, color, size } => vec![shape(mark, at, color, size)],
        Thing::Words { at: (x, y), text, size, centred, bold, color } => vec![Primitive::Text {
            x,
            y,
            content: text,
            size,
            anchor: if centred { TextAnchor::Middle } else { TextAnchor::Start },
            rotate: None,
            bold,
            color: color.map(Color::from),
        }],
    }
}

/// Shaft and head; the head takes at most a fixed share of a short arrow.
fn arrow(from: (f64, f64), to: (f64, f64), color: &str, width: f64) -> Vec<Primitive> {
    let length = (to.0 - from.0).hypot(to.1 - from.1);
    if length < 1.0 {
        return vec![];
    }
    let head = (2.0 * width + 4.5).min(0.65 * length);
    let (foot, corners) = arrowhead(from, to, head, 0.45 * head);
    vec![line(from, foot, Color::from(color), width), area(&corners, Color::from(color))]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrows_end_at_their_tip_and_tiny_ones_are_omitted() {
        let arrow = arrow((10.0, 20.0), (40.0, 20.0), "#000000", 2.0);
        let [Primitive::Line { x1, x2, .. }, Primitive::Path(head)] = &arrow[..] else { panic!("{arrow:?}") };
        assert!((x1 - 10.0).abs() < 1e-12 && (x2 - 31.5).abs() < 1e-12, "{arrow:?}");
        assert!(head.d.starts_with("M40.00 20.00L31.50"), "{}", head.d);
        assert!(super::arrow((1.0, 1.0), (1.0, 1.5), "#000000", 2.0).is_empty());
    }

    #[test]
    fn things_are_drawn_in_their_order() {
        let stroke = Stroke { color: "#0072b2", width: 1.0, dash: crate::Dash::Solid };
        let words = |text: &str, centred| {
            let (at, text, size, bold, color) = ((5.0, 9.0), text.to_owned(), 13, centred, None);
            Thing::Words { at, text, size, centred, bold, color }
        };
        let things = vec![
            Thing::Line { points: vec![(0.0, 0.0), (1.0, 2.0)], stroke },
            Thing::Mark { at: (3.0, 4.0), mark: Mark::Circle, color: "#d55e00", size: 2.0 },
            words("left", false),
            words("middle", true),
        ];
        let Sketch { scene, .. } = Canvas { things, size: (60.0, 40.0) }.sketch();
        assert!((scene.width, scene.height) == (60.0, 40.0));
        assert!(matches!(
            &scene.elements[..],
            [
                Primitive::PolyLine { .. },
                Primitive::Circle { .. },
                Primitive::Text { anchor: TextAnchor::Start, color: None, .. },
                Primitive::Text { anchor: TextAnchor::Middle, bold: true, .. }
            ]
        ));
    }
}
