//! Vertical text as pixels. The plotting crate resamples text when it rotates it, which makes it jagged.

use kuva::backend::raster::RasterBackend;
use kuva::render::color::Color;
use kuva::render::render::{Primitive, Scene, TextAnchor};

use crate::drawing::elements::{rectangle, words};
use crate::drawing::raster::DOTS;

/// Rotation of the text along a vertical axis, degrees.
const UPWARDS: f64 = -90.0;

/// An element, prepared for pixels. Vertical text is drawn horizontally, and its dots are rotated, which is lossless.
pub(crate) fn drawn(element: Primitive, font_family: Option<&String>) -> Vec<Primitive> {
    let upright = |turn: &f64| (turn - UPWARDS).abs() < 1e-9;
    match &element {
        Primitive::Text { x, y, content, size, anchor: TextAnchor::Middle, rotate: Some(turn), color, .. }
            if upright(turn) =>
        {
            let color = color.clone().unwrap_or_else(|| Color::from("#000000"));
            dots(content, *size, font_family)
                .map_or_else(|| vec![element.clone()], |dots| areas(&dots, (*x, *y), &color))
        }
        _ => vec![element],
    }
}

/// Coverage of each dot by horizontal text, with the dot's position (right, down) relative to the centre of the baseline, in
/// dots.
fn dots(content: &str, size: u32, font_family: Option<&String>) -> Option<Vec<(f64, f64, f64)>> {
    let size_px = f64::from(size);
    let (width, foot) = ((content.chars().count() as f64 * size_px).ceil() + 20.0, (1.5 * size_px).ceil());
    let mut scene = Scene::new(width, 2.0 * size_px.ceil());
    scene.font_family = font_family.cloned();
    scene.add(words((width / 2.0, foot), content, size, TextAnchor::Middle));
    let file = RasterBackend::new().with_scale(DOTS as f32).render_scene(&scene).ok()?;
    let mut decoder = png::Decoder::new(std::io::Cursor::new(file));
    decoder.set_transformations(png::Transformations::normalize_to_color8() | png::Transformations::ALPHA);
    let mut reader = decoder.read_info().ok()?;
    let mut picture = vec![0; reader.output_buffer_size()?];
    let frame = reader.next_frame(&mut picture).ok()?;
    let scale = DOTS as f64;
    let dot = |(at, pixel): (usize, &[u8])| {
        // Black text on white, or on a transparent background.
        let share = f64::from(pixel[3]) / 255.0 * (1.0 - f64::from(pixel[0]) / 255.0);
        let [column, row] = [at % frame.width as usize, at / frame.width as usize].map(|place| place as f64);
        (share > 0.0).then_some((column - (width / 2.0 * scale).round(), row - foot * scale, share))
    };
    Some(picture.chunks_exact(4).enumerate().filter_map(dot).collect())
}

/// The dots, rotated about the centre of the baseline.
fn areas(dots: &[(f64, f64, f64)], (x, y): (f64, f64), color: &Color) -> Vec<Primitive> {
    let side = 1.0 / DOTS as f64;
    let [x, y] = [x, y].map(|place| (place / side).round() * side);
    let area = |&(right, down, share): &(f64, f64, f64)| {
        rectangle((x + down * side, y - (right + 1.0) * side), (side, side), color.clone(), share)
    };
    dots.iter().map(area).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vertical_text_has_the_dots_of_horizontal_text() {
        let words = |rotate| Primitive::Text {
            x: 100.0,
            y: 80.0,
            content: "Distance".to_owned(),
            size: 14,
            anchor: TextAnchor::Middle,
            rotate,
            bold: false,
            color: None,
        };
        let level = dots("Distance", 14, None).unwrap();
        assert!(level.len() > 200, "{} dots", level.len());
        let up = drawn(words(Some(UPWARDS)), None);
        assert_eq!(up.len(), level.len());
        for (area, (right, down, share)) in up.iter().zip(level) {
            let Primitive::Rect { x, y, opacity, .. } = area else { panic!("{area:?}") };
            let expected = (100.0 + 0.5 * down, 80.0 - 0.5 * (right + 1.0));
            assert!((x - expected.0).abs() + (y - expected.1).abs() < 1e-9 && *opacity == Some(share));
        }
        assert_eq!(drawn(words(None), None).len(), 1);
    }
}
