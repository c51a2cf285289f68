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
        let columns = self.columns();
        let left = ((self.width - columns.iter().sum::<f64>()) / 2.0).max(0.0);
        for (row, entries) in self.rows.iter().enumerate() {
            let mut x = left;
            for (entry, column) in entries.iter().zip(&columns) {
                entry.draw((x, ROW * (row as f64 + 0.5)), &mut scene);
                x += column;
            }
        }
        Sketch::new(scene)
    }
}

impl Key {
    /// How wide each column is, by the longest of its names.
    fn columns(&self) -> Vec<f64> {
        let most = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let letters = |column: usize| {
            let names = self.rows.iter().filter_map(|row| row.get(column));
            names.map(|entry| entry.name.chars().count()).max().unwrap_or(0)
        };
        (0..most).map(|column| SAMPLE + GAP + LETTER * letters(column) as f64 + 3.0 * GAP).collect()
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

#[cfg(test)]
mod tests {
    use kuva::render::render::Primitive;

    use super::*;
    use crate::{Dash, Filling, Mark};

    #[test]
    fn columns_are_as_wide_as_their_names_and_all_is_on_the_panel() {
        let entry = |name: &str| Entry {
            name: name.to_owned(),
            stroke: Stroke { color: "#000000", width: 1.0, dash: Dash::Solid },
            sign: Sign { mark: Mark::Star, filling: Filling::Full },
        };
        let rows =
            vec![vec![entry("a"), entry("a rather long name of something"), entry("b")], vec![entry("c"), entry("d")]];
        let key = Key { rows, width: 480.0 };
        let starts: Vec<f64> = key
            .sketch()
            .scene
            .elements
            .iter()
            .filter_map(|element| if let Primitive::Text { x, .. } = element { Some(*x) } else { None })
            .collect();
        assert!((starts[0] - starts[3]).abs() + (starts[1] - starts[4]).abs() < 1e-9, "{starts:?}");
        assert!(starts[1] - starts[0] < 0.4 * (starts[2] - starts[1]), "{starts:?}");
        assert!(starts[0] > 0.0 && starts[2] + LETTER < key.width, "{starts:?}");
    }
}
