use serde::{Deserialize, Serialize};

use crate::PlotError;

/// A scalar field on a grid of at least two columns and two rows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Record")]
pub struct Field {
    x: Vec<f64>,
    y: Vec<f64>,
    values: Vec<Vec<f64>>,
}

impl Field {
    /// `values[row][column]` at (`x[column]`, `y[row]`); values that are not finite are not drawn.
    ///
    /// # Errors
    /// [`PlotError::FieldPlaces`], [`PlotError::FieldRows`] and [`PlotError::FieldRow`] if the lengths do not form a grid.
    pub fn new(x: Vec<f64>, y: Vec<f64>, values: Vec<Vec<f64>>) -> Result<Field, PlotError> {
        for (axis, places) in [("x", x.len()), ("y", y.len())] {
            if places < 2 {
                return Err(PlotError::FieldPlaces { axis, places });
            }
        }
        if values.len() != y.len() {
            return Err(PlotError::FieldRows { found: values.len(), expected: y.len() });
        }
        let uneven = values.iter().map(Vec::len).enumerate().find(|(_, found)| *found != x.len());
        uneven.map_or(Ok(()), |(row, found)| Err(PlotError::FieldRow { row, found, expected: x.len() }))?;
        Ok(Field { x, y, values })
    }

    /// x coordinates of the columns.
    pub fn x(&self) -> &[f64] {
        &self.x
    }

    /// y coordinates of the rows.
    pub fn y(&self) -> &[f64] {
        &self.y
    }

    /// The values, one row for each y.
    pub fn values(&self) -> &[Vec<f64>] {
        &self.values
    }
}

/// The stored form.
#[derive(Deserialize)]
struct Record {
    x: Vec<f64>,
    y: Vec<f64>,
    values: Vec<Vec<f64>>,
}

impl TryFrom<Record> for Field {
    type Error = PlotError;

    fn try_from(Record { x, y, values }: Record) -> Result<Field, PlotError> {
        Field::new(x, y, values)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invalid_grids_are_refused() {
        let checked = |columns: usize, rows: &[usize], places: usize| {
            let values = rows.iter().map(|&row| vec![0.0; row]).collect();
            Field::new(vec![0.0; columns], vec![0.0; places], values).map(|_| ())
        };
        let cases = [
            (checked(3, &[3, 3], 2), Ok(())),
            (checked(1, &[1, 1], 2), Err(PlotError::FieldPlaces { axis: "x", places: 1 })),
            (checked(2, &[2], 1), Err(PlotError::FieldPlaces { axis: "y", places: 1 })),
            (checked(2, &[2, 2], 3), Err(PlotError::FieldRows { found: 2, expected: 3 })),
            (checked(2, &[2, 3], 2), Err(PlotError::FieldRow { row: 1, found: 3, expected: 2 })),
        ];
        for (found, expected) in cases {
            assert_eq!(found, expected);
        }
    }
}
