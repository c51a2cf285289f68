//! Contours at round values, with labels.

use kuva::plot::ContourPlot;
use kuva::render::annotations::TextAnnotation;
use kuva::render::color::Color;
use kuva::render::plots::Plot;
use kuva::render::render::{Primitive, Scene};

use crate::Field;
use crate::drawing::elements::rectangle;
use crate::ticks::{decimals, ticks};

/// Approximate number of contours.
const LINES: f64 = 9.0;
const LINE: &str = "#a8a8a8";

/// Font size of labels, and the width of a letter, pixels; no other text of a plane has this size.
const SIZE: u32 = 10;
const LETTER: f64 = 6.4;
const INK: &str = "#5a5a5a";

/// Distance between text and the point below it in the plotting crate, pixels.
const ABOVE: f64 = 6.0;

/// Minimum distance between labels, as a share of the panel.
const APART: f64 = 0.05;

/// Number of points of the line along which labels are placed.
const POINTS: usize = 400;

/// A label on its contour.
#[derive(Debug, PartialEq)]
pub(crate) struct Written {
    at: (f64, f64),
    text: String,
}

impl Written {
    pub(crate) fn annotation(&self) -> TextAnnotation {
        TextAnnotation::new(&self.text, self.at.0, self.at.1).with_font_size(SIZE)
    }
}

/// The contours; `None` if the field is constant where it is known.
pub(crate) fn lines(field: &Field, known: &[Vec<bool>], label: String) -> Option<Plot> {
    let levels = levels(field, known);
    let contours = ContourPlot::new()
        .with_grid(field.values().to_vec(), field.x().to_vec(), field.y().to_vec())
        .with_levels(&levels);
    (!levels.is_empty()).then(|| Plot::Contour(contours.with_line_color(LINE).with_line_width(0.9).with_legend(label)))
}

/// The labels, along the straight line from the lowest known grid point to the highest, which crosses every contour.
pub(crate) fn written(field: &Field, known: &[Vec<bool>]) -> Vec<Written> {
    let levels = levels(field, known);
    let decimals = decimals(&levels);
    let (Some(low), Some(high)) = (extreme(field, known, 1.0), extreme(field, known, -1.0)) else { return vec![] };
    let extent = [field.x(), field.y()].map(|grid| grid[grid.len() - 1] - grid[0]).into_iter().fold(0.0, f64::max);
    let line: Vec<_> = (0..=POINTS).map(|i| field.between(low, high, i as f64 / POINTS as f64)).collect();
    let mut written: Vec<Written> = vec![];
    for level in levels {
        let met = line.windows(2).find(|pair| (pair[0].1 <= level) != (pair[1].1 <= level));
        let Some(at) = met.map(|pair| pair[0].0) else { continue };
        let far = |other: &Written| (other.at.0 - at.0).hypot(other.at.1 - at.1) >= APART * extent;
        if written.iter().all(far) {
            let text = format!("{level:.decimals$}");
            written.push(Written { at, text: if level == 0.0 { "0".to_owned() } else { text } });
        }
    }
    written
}

/// Puts labels on their contours, which are interrupted there.
pub(crate) fn put_on_lines(values: &[Written], scene: &mut Scene) {
    let mut drawn = Vec::with_capacity(scene.elements.len());
    for mut element in std::mem::take(&mut scene.elements) {
        if let Primitive::Text { x, y, content, size: SIZE, color, .. } = &mut element
            && values.iter().any(|value| value.text == *content)
        {
            *y += ABOVE + 0.36 * f64::from(SIZE);
            *color = Some(Color::from(INK));
            let (width, height) = (LETTER * content.chars().count() as f64 + 4.0, f64::from(SIZE) + 2.0);
            let corner = (*x - width / 2.0, *y - 0.36 * f64::from(SIZE) - height / 2.0);
            drawn.push(rectangle(corner, (width, height), Color::from("#ffffff"), 0.85));
        }
        drawn.push(element);
    }
    scene.elements = drawn;
}

/// Round values between the smallest and the largest known value.
fn levels(field: &Field, known: &[Vec<bool>]) -> Vec<f64> {
    let value = |(row, column): (usize, usize)| field.values()[row][column];
    match (extreme(field, known, 1.0).map(value), extreme(field, known, -1.0).map(value)) {
        (Some(low), Some(high)) if low < high => ticks(low, high, LINES),
        _ => vec![],
    }
}

/// Row and column of the known grid point with the smallest value, or the largest if `sign` is −1.
fn extreme(field: &Field, known: &[Vec<bool>], sign: f64) -> Option<(usize, usize)> {
    let places = (0..field.y().len()).flat_map(|row| (0..field.x().len()).map(move |column| (row, column)));
    let value = |&(row, column): &(usize, usize)| field.values()[row][column];
    let is_known = |&(row, column): &(usize, usize)| known.get(row).and_then(|row| row.get(column)) == Some(&true);
    let known = places.filter(|place| is_known(place) && value(place).is_finite());
    known.min_by(|a, b| (sign * value(a)).total_cmp(&(sign * value(b))))
}

impl Field {
    /// Position and value at a share of the way from one grid point to another, (row, column).
    fn between(&self, from: (usize, usize), to: (usize, usize), share: f64) -> ((f64, f64), f64) {
        let (x, y, values) = (self.x(), self.y(), self.values());
        let along = |from: usize, to: usize| from as f64 + share * (to as f64 - from as f64);
        let (row, column) = (along(from.0, to.0), along(from.1, to.1));
        let split = |place: f64, length: usize| {
            let below = (place as usize).min(length - 2);
            (below, place - below as f64)
        };
        let ((i, up), (j, right)) = (split(row, y.len()), split(column, x.len()));
        let mix = |a: f64, b: f64, share: f64| a * (1.0 - share) + b * share;
        let level = |i: usize| mix(values[i][j], values[i][j + 1], right);
        let at = (mix(x[j], x[j + 1], right), mix(y[i], y[i + 1], up));
        (at, mix(level(i), level(i + 1), up))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x² + y² on a square from −2 to 2.
    fn bowl() -> Field {
        let grid: Vec<f64> = (-20..=20).map(|i| f64::from(i) / 10.0).collect();
        let values = grid.iter().map(|y| grid.iter().map(|x| x * x + y * y).collect()).collect();
        Field::new(grid.clone(), grid, values).unwrap()
    }

    #[test]
    fn contour_labels_lie_on_their_lines() {
        let field = bowl();
        let written = written(&field, &vec![vec![true; 41]; 41]);
        assert!(written.len() >= 4, "{written:?}");
        for Written { at: (x, y), text } in written {
            assert!((x * x + y * y - text.parse::<f64>().unwrap()).abs() < 0.1, "{text} at {x}, {y}");
        }
    }

    #[test]
    fn contours_use_only_known_values() {
        let field = bowl();
        let known: Vec<Vec<bool>> =
            field.y().iter().map(|y| field.x().iter().map(|x| x.hypot(*y) <= 1.0).collect()).collect();
        let levels = levels(&field, &known);
        assert!(levels.len() > 2 && levels.iter().all(|level| (0.0..=1.0).contains(level)), "{levels:?}");
        assert!(written(&field, &known).iter().all(|value| value.at.0.hypot(value.at.1) <= 1.01));
        for known in [vec![vec![false; 41]; 41], vec![vec![true; 41]; 41]] {
            let flat = Field::new(field.x().to_vec(), field.y().to_vec(), vec![vec![3.0; 41]; 41]).unwrap();
            assert!(lines(&flat, &known, String::new()).is_none() && written(&flat, &known).is_empty());
        }
    }
}
