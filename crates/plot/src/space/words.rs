//! Text of a scene.

use kuva::render::color::Color;
use kuva::render::render::{Scene, TextAnchor};
use nalgebra::Point2;

use super::item::{DISC, WORDS};
use super::view::View;
use super::{Item, legend, shade};
use crate::drawing::elements::{disc, polyline};

/// Notes farther than this from their point get a line to it, pixels.
const FAR: f64 = 14.0;

/// Draws the text of an item.
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
