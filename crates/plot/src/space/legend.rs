//! Legend below the scene, and text on the panel.

use kuva::render::color::Color;
use kuva::render::render::{Primitive, Scene, TextAnchor};
use nalgebra::Point3;

use super::item::WORDS;
use super::{Item, MARGIN, stroke};
use crate::Stroke;

/// Height of a row, pixels.
const ROW: f64 = 20.0;
/// Length of the line before a name, pixels.
const SAMPLE: f64 = 30.0;
/// Distance between names, pixels.
const APART: f64 = 18.0;

/// Names with their line styles.
pub(super) type Names<'i> = Vec<(&'i str, Stroke)>;

/// The names of lines, without duplicates.
pub(super) fn names<'i>(items: impl Iterator<Item = &'i Item>) -> Names<'i> {
    let mut names: Names<'i> = vec![];
    for item in items {
        if let Item::Path { stroke, label: Some(label), .. } = item
            && !names.iter().any(|(name, _)| name == label)
        {
            names.push((label, *stroke));
        }
    }
    names
}

/// Height of the legend below the scene, pixels.
pub(super) fn height(names: &Names<'_>, width: f64) -> f64 {
    rows(names, width).len() as f64 * ROW
}

/// Draws the legend centred at the lower edge.
pub(super) fn draw(names: &Names<'_>, (width, height): (f64, f64), scene: &mut Scene) {
    let rows = rows(names, width);
    let top = height - MARGIN - rows.len() as f64 * ROW;
    for (i, row) in rows.iter().enumerate() {
        let y = top + ROW * (i as f64 + 0.5);
        let taken: f64 = row.iter().map(|(name, _)| extent(name)).sum::<f64>() - APART;
        let mut x = (width - taken) / 2.0;
        for (name, stroke) in *row {
            let sample = [Point3::new(x, y, 0.0), Point3::new(x + SAMPLE, y, 0.0)];
            stroke::line(&sample, stroke, &[], scene);
            scene.add(text((x + SAMPLE + 5.0, y + 4.0), name, TextAnchor::Start, "#000000", None));
            x += extent(name);
        }
    }
}

/// Splits the names into rows as the width permits.
fn rows<'n, 'i>(names: &'n Names<'i>, width: f64) -> Vec<&'n [(&'i str, Stroke)]> {
    let widest = names.iter().map(|(name, _)| extent(name)).fold(1.0, f64::max);
    let columns = ((width - 2.0 * MARGIN + APART) / widest).floor().max(1.0) as usize;
    names.chunks(columns).collect()
}

fn extent(name: &str) -> f64 {
    SAMPLE + 5.0 + width(name, WORDS) + APART
}

/// Estimated width of a text in pixels, rather too large than too small.
pub(super) fn width(text: &str, size: u32) -> f64 {
    0.62 * f64::from(size) * text.chars().count() as f64
}

/// A text, rotated by this many degrees.
pub(super) fn text((x, y): (f64, f64), text: &str, anchor: TextAnchor, color: &str, rotate: Option<f64>) -> Primitive {
    let (content, color) = (text.to_owned(), Some(Color::from(color)));
    Primitive::Text { x, y, content, size: WORDS, anchor, rotate, bold: false, color }
}
