//! Pixels behind a drawing.

use std::fmt::Write as _;

use kuva::render::color::Color;
use kuva::render::render::Primitive;

use crate::drawing::elements::rectangle;

/// Number of dots along a side of a pixel.
pub(crate) const DOTS: usize = 2;

/// A rectangle of coloured dots.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Raster {
    /// Position of its upper left corner, pixels.
    pub(crate) corner: (f64, f64),
    /// Width and height of a dot, pixels.
    pub(crate) side: f64,
    /// Number of dots per row.
    pub(crate) width: usize,
    /// Red, green, blue and opacity; row by row.
    pub(crate) dots: Vec<[u8; 4]>,
}

impl Raster {
    fn height(&self) -> usize {
        self.dots.len() / self.width
    }

    /// The raster as an element of a drawing.
    pub(crate) fn svg(&self) -> String {
        let ((x, y), [width, height]) = (self.corner, [self.width, self.height()].map(|dots| dots as f64 * self.side));
        let data = base64(&self.png());
        format!(r#"<image x="{x}" y="{y}" width="{width}" height="{height}" href="data:image/png;base64,{data}"/>"#)
    }

    /// The raster as rectangles of one colour each, whose sides are whole numbers of dots.
    pub(crate) fn areas(&self) -> Vec<Primitive> {
        let side = self.side;
        // If dots do not coincide with those of the file, neighbours overlap slightly; otherwise gaps would be visible
        // between them.
        let lap = if (side * DOTS as f64 - 1.0).abs() < 1e-12 { 0.0 } else { side / 2.0 };
        let mut areas = vec![];
        for (row, dots) in self.dots.chunks(self.width).enumerate() {
            let mut column = 0;
            for run in dots.chunk_by(|a, b| a == b) {
                let [red, green, blue, share] = run[0];
                if share > 0 {
                    let corner = (self.corner.0 + column as f64 * side, self.corner.1 + row as f64 * side);
                    let size = (run.len() as f64 * side + lap, side + lap);
                    areas.push(rectangle(corner, size, Color::Rgb(red, green, blue), f64::from(share) / 255.0));
                }
                column += run.len();
            }
        }
        areas
    }

    /// The raster as a PNG file.
    fn png(&self) -> Vec<u8> {
        let mut file = Vec::new();
        let mut encoder = png::Encoder::new(&mut file, self.width as u32, self.height() as u32);
        encoder.set_color(png::ColorType::Rgba);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::High);
        let written = encoder.write_header().and_then(|mut writer| writer.write_image_data(self.dots.as_flattened()));
        written.expect("a picture of some dots, all rows as wide, can be written to memory");
        file
    }
}

/// Length of a PNG file's signature and its first chunk, after which chunks about the whole picture are allowed.
const HEAD: usize = 8 + 25;

/// The chunk "pHYs": length, name, dots per metre across and down, their unit, checksum.
const DENSITY: [u8; 21] = *b"\0\0\0\x09pHYs\0\0\x1d\x87\0\0\x1d\x87\x01\x8f\xe5\xf1\x65";

/// Adds the intended size to a PNG file: [`DOTS`] per pixel, 96 pixels per inch.
pub(crate) fn with_density(mut file: Vec<u8>) -> Vec<u8> {
    file.splice(HEAD..HEAD, DENSITY);
    file
}

/// Encodes bytes as base 64 (RFC 4648).
fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let bits = (0..3).fold(0, |bits, i| bits << 8 | three.get(i).copied().map_or(0, u32::from));
        for i in 0..4 {
            let letter = char::from(LETTERS[(bits >> (18 - 6 * i) & 63) as usize]);
            let _ = write!(text, "{}", if i <= three.len() { letter } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_matches_the_rfc() {
        let texts = ["", "f", "fo", "foo", "foob", "fooba", "foobar"].map(|text| base64(text.as_bytes()));
        assert_eq!(texts, ["", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"]);
    }

    #[test]
    fn areas_are_runs_of_one_visible_colour() {
        let (red, none) = ([255, 0, 0, 255], [0; 4]);
        let raster = Raster { corner: (3.0, 4.0), side: 0.5, width: 3, dots: vec![red, red, none, none, none, red] };
        let areas: Vec<_> = raster
            .areas()
            .iter()
            .map(|area| match area {
                Primitive::Rect { x, y, width, height, .. } => [*x, *y, *width, *height],
                other => panic!("{other:?}"),
            })
            .collect();
        assert_eq!(areas, [[3.0, 4.0, 1.0, 0.5], [4.0, 4.5, 0.5, 0.5]]);
    }
}
