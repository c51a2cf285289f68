//! Fields in smooth colours, without visible squares: interpolates dots between the grid points.

use kuva::render::render::{Primitive, Scene};

use crate::drawing::raster::Raster;
use crate::drawing::style::height;
use crate::{Field, Sketch};

/// Number of dots from one grid point to the next.
const DOTS: usize = 3;

/// Replaces a field's stand-in of two by two squares in a scene by a placeholder for pixels; returns the pixels.
pub(crate) fn instead_of_squares(field: &Field, colors: [f64; 2], number: usize, scene: &mut Scene) -> Option<Raster> {
    let at = scene.elements.iter().position(|element| matches!(element, Primitive::RectBatch { .. }))?;
    let Primitive::RectBatch { x, y, .. } = &scene.elements[at] else { return None };
    let ([left, right], [top, _]) = (range(x), range(y));
    // Two squares are as wide as the field; both axes have the same scale.
    let width = DOTS * (field.x().len() - 1);
    let side = 2.0 * (right - left) / width as f64;
    let ends = [Primitive::GroupEnd, Primitive::GroupEnd];
    scene.elements.splice(at..=at, [Sketch::backdrop(), Sketch::group(number)].into_iter().chain(ends));
    Some(Raster { corner: (left, top), side, width, dots: dots(field, colors) })
}

/// Smallest and largest value.
pub(crate) fn range<'a>(values: impl IntoIterator<Item = &'a f64>) -> [f64; 2] {
    let wider = |[low, high]: [f64; 2], &value: &f64| [low.min(value), high.max(value)];
    values.into_iter().fold([f64::INFINITY, f64::NEG_INFINITY], wider)
}

/// Colours of the dots, row by row from the top; `low` and `high` are the values of the darkest and the lightest
/// colour.
fn dots(field: &Field, [low, high]: [f64; 2]) -> Vec<[u8; 4]> {
    let values = field.values();
    let [width, rows] = [field.x(), field.y()].map(|grid| DOTS * (grid.len() - 1));
    let place = |dot: usize| {
        let along = (dot as f64 + 0.5) / DOTS as f64;
        (along as usize, along.fract())
    };
    let dot = |row: usize, column: usize| {
        let ((i, up), (j, right)) = (place(row), place(column));
        let level = |i: usize| values[i][j] * (1.0 - right) + values[i][j + 1] * right;
        let value = level(i) * (1.0 - up) + level(i + 1) * up;
        let share = (value - low) / (high - low);
        // A constant field has the middle colour.
        let [r, g, b] = height(if share.is_nan() { 0.5 } else { share });
        [r, g, b, if value.is_finite() { 255 } else { 0 }]
    };
    (0..rows)
        .rev()
        .flat_map(|row| (0..width).map(move |column| (row, column)))
        .map(|(row, column)| dot(row, column))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_go_evenly_from_the_lowest_place_to_the_highest() {
        let grid: Vec<f64> = (0..5).map(f64::from).collect();
        let values = grid.iter().map(|y| grid.iter().map(|_| *y).collect()).collect();
        let field = Field::new(grid.clone(), grid, values).unwrap();
        let dots = dots(&field, [0.0, 4.0]);
        assert_eq!(dots.len(), 12 * 12);
        let column: Vec<_> = dots.iter().step_by(12).collect();
        let light = |dot: &[u8; 4]| dot[..3].iter().map(|&part| i32::from(part)).sum::<i32>();
        assert!(column.windows(2).all(|pair| light(pair[0]) > light(pair[1])), "{column:?}");
        assert!(dots[..12].iter().all(|dot| dot == &dots[0]));
        // If the scale extends twice as far up, the highest value has the middle colour.
        let darker = super::dots(&field, [0.0, 8.0]);
        assert!(light(&darker[0]) < light(&dots[0]) && darker[0][..3] == height(0.5 - 1.0 / 48.0));
    }

    #[test]
    fn level_fields_have_the_middle_colour_and_unknown_none() {
        let level_field = |value| Field::new(vec![0.0, 1.0], vec![0.0, 1.0], vec![vec![value; 2]; 2]).unwrap();
        let [r, g, b] = height(0.5);
        assert!(dots(&level_field(3.0), [3.0, 3.0]).iter().all(|dot| *dot == [r, g, b, 255]));
        assert!(dots(&level_field(f64::NAN), [0.0, 1.0]).iter().all(|dot| dot[3] == 0));
    }
}
