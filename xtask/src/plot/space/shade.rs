//! Light and shadow: light falls from the left, from above and from behind the viewer.

use kuva::render::color::Color;
use nalgebra::Vector3;

use super::Paint;

/// What is in full shadow keeps this share of its lightness.
const SHADOW: f64 = 0.66;

/// Towards the light, on the panel: right, down, towards the viewer.
pub(super) fn light() -> Vector3<f64> {
    Vector3::new(-0.5, -0.62, 0.6).normalize()
}

/// How much light a face gets, from 0 to 1: `normal` points out of the body.
pub(super) fn lit(normal: &Vector3<f64>) -> f64 {
    f64::midpoint(normal.normalize().dot(&light()), 1.0)
}

/// A colour, `#rrggbb`, in so much light.
pub(super) fn shade(color: &str, lit: f64) -> Color {
    scaled(color, SHADOW + (1.0 - SHADOW) * lit)
}

/// The colour of outlines: dark, or where things behind can be seen less so.
pub(super) fn ink(paint: &Paint) -> Color {
    scaled(paint.color, if paint.opacity < 1.0 { 0.6 } else { 0.3 })
}

/// Black or white, whichever can be read on a colour.
pub(super) fn word_on(color: &str) -> &'static str {
    let Color::Rgb(r, g, b) = Color::from(color) else { return "#000000" };
    // As light as it looks.
    let lightness = 0.3 * f64::from(r) + 0.59 * f64::from(g) + 0.11 * f64::from(b);
    if lightness > 140.0 { "#000000" } else { "#ffffff" }
}

fn scaled(color: &str, share: f64) -> Color {
    match Color::from(color) {
        Color::Rgb(r, g, b) => {
            let [r, g, b] = [r, g, b].map(|part| (f64::from(part) * share).round() as u8);
            Color::Rgb(r, g, b)
        }
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_differ_from_what_is_behind_them() {
        let behind = ["#000000", "#0072b2", "#cc79a7", "#f0e442", "#ffffff"];
        assert_eq!(behind.map(word_on), ["#ffffff", "#ffffff", "#000000", "#000000", "#000000"]);
    }
}
