use kuva::plot::LineStyle;
use kuva::render::color::Color;
use kuva::render::render::{Primitive, Scene, TextAnchor};

use crate::{Panel, Sign, Sketch, Stroke};

/// The names of curves, for all panels above it.
#[derive(Debug, Clone)]
pub struct Key {
    /// Rows of names.
    pub rows: Vec<Vec<Entry>>,
    /// Pixels.
    pub width: f64,
}

/// One name.
#[derive(Debug, Clone)]
pub struct Entry {
    /// As it is written.
    pub name: String,
    /// Its line.
    pub stroke: Stroke,
    /// Its mark, in the middle of the line.
    pub sign: Sign,
}

/// Pixels of a row, of the line before a name, and of its gap to the name.
const ROW: f64 = 22.0;
const SAMPLE: f64 = 40.0;
const GAP: f64 = 6.0;

/// Size of names, pixels, and how wide a letter is at most.
const SIZE: u32 = 13;
const LETTER: f64 = 7.6;

impl Panel for Key {
    fn sketch(&self) -> Sketch {
        let mut scene = Scene::new(self.width, ROW * self.rows.len() as f64);
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let letters = self.rows.iter().flatten().map(|entry| entry.name.chars().count()).max().unwrap_or(0);
        let column = SAMPLE + GAP + LETTER * letters as f64 + 3.0 * GAP;
        let left = ((self.width - column * columns as f64) / 2.0).max(0.0);
        for (row, entries) in self.rows.iter().enumerate() {
            for (place, entry) in entries.iter().enumerate() {
                entry.draw((left + column * place as f64, ROW * (row as f64 + 0.5)), &mut scene);
            }
        }
        Sketch::new(scene)
    }
}

impl Entry {
    /// Draws sample and name, from the middle of the sample's left end.
    fn draw(&self, (x, y): (f64, f64), scene: &mut Scene) {
        scene.add(Primitive::Line {
            x1: x,
            y1: y,
            x2: x + SAMPLE,
            y2: y,
            stroke: Color::from(self.stroke.color),
            stroke_width: self.stroke.width,
            stroke_dasharray: LineStyle::from(self.stroke.dash).dasharray(),
        });
        self.sign.draw((x + SAMPLE / 2.0, y), self.stroke.color, scene);
        scene.add(Primitive::Text {
            x: x + SAMPLE + GAP,
            y: y + 0.36 * f64::from(SIZE),
            content: self.name.clone(),
            size: SIZE,
            anchor: TextAnchor::Start,
            rotate: None,
            bold: false,
            color: None,
        });
    }
}
