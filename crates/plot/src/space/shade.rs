//! Shading: light comes from the left, from above and from behind the viewer.

use kuva::render::color::Color;
use nalgebra::Vector3;

use super::Paint;

/// Red, green and blue, from 0 to 255.
pub(super) type Rgb = [f64; 3];

/// A [`Paint`] with a parsed colour.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tint {
    color: Rgb,
    pub(super) opacity: f64,
}

impl From<Paint> for Tint {
    fn from(paint: Paint) -> Self {
        Tint { color: rgb(paint.color), opacity: paint.opacity }
    }
}

/// Brightness in full shadow, as a share of full brightness.
const SHADOW: f64 = 0.66;

/// Direction towards the light, on the panel: right, down, towards the viewer.
pub(super) fn light() -> Vector3<f64> {
    Vector3::new(-0.5, -0.62, 0.6).normalize()
}

/// The colour of a body where its surface has this outward unit normal; transparent bodies are not shaded.
pub(super) fn seen(tint: &Tint, normal: &Vector3<f64>) -> Rgb {
    let lit = if tint.opacity < 1.0 { 1.0 } else { f64::midpoint(normal.dot(&light()), 1.0) };
    tint.color.map(|part| part * (SHADOW + (1.0 - SHADOW) * lit))
}

/// The colour of outlines: dark, or less dark for transparent bodies.
pub(super) fn ink(tint: &Tint) -> Rgb {
    tint.color.map(|part| part * if tint.opacity < 1.0 { 0.6 } else { 0.3 })
}

/// Black or white, whichever is legible on a colour.
pub(super) fn word_on(color: &str) -> &'static str {
    let [red, green, blue] = rgb(color);
    // Perceived lightness.
    let lightness = 0.3 * red + 0.59 * green + 0.11 * blue;
    if lightness > 140.0 { "#000000" } else { "#ffffff" }
}

/// The components of a colour in HTML notation, `#rrggbb`; black if it has another form.
pub(super) fn rgb(color: &str) -> Rgb {
    match Color::from(color) {
        Color::Rgb(red, green, blue) => [red, green, blue].map(f64::from),
        _ => [0.0; 3],
    }
}

/// A colour in the plotting crate's form.
pub(super) fn color(rgb: Rgb) -> Color {
    let [red, green, blue] = rgb.map(|part| part.round() as u8);
    Color::Rgb(red, green, blue)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_contrasts_with_its_background() {
        let behind = ["#000000", "#0072b2", "#cc79a7", "#f0e442", "#ffffff"];
        assert_eq!(behind.map(word_on), ["#ffffff", "#ffffff", "#000000", "#000000", "#000000"]);
    }

    #[test]
    fn the_side_towards_the_light_is_lighter() {
        let brightness = |normal: Vector3<f64>| seen(&Paint::opaque("#ffffff").into(), &normal)[0];
        assert!((brightness(light()) - 255.0).abs() < 1e-9);
        let [top, front, right] = [-Vector3::y(), Vector3::z(), Vector3::x()].map(brightness);
        assert!(top > front - 3.0 && front > right && right > 150.0);
    }
}
