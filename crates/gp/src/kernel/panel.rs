use lanes::{LANES, Lanes};
use nalgebra::DMatrix;

/// Number of columns stored side by side.
pub(crate) const ABREAST: usize = 2 * LANES;

/// One row of [`ABREAST`] columns, aligned to a cache line.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
pub(crate) struct PanelRow(pub(crate) [Lanes; 2]);

/// Columns of a matrix (M, k), each in a separate lane: results for one column have the same bits whatever the others are.
///
/// The height is M, rounded up to whole groups; the rows beyond M are 0.
#[derive(Debug, Clone)]
pub(crate) struct Panel {
    numbers: Vec<PanelRow>,
    rows: usize,
    columns: usize,
}

impl Panel {
    pub(crate) fn zeros(rows: usize, columns: usize) -> Self {
        let height = rows.next_multiple_of(LANES);
        Panel { numbers: vec![PanelRow([[0.0; LANES]; 2]); height * columns.div_ceil(ABREAST)], rows, columns }
    }

    pub(crate) fn of(matrix: &DMatrix<f64>) -> Self {
        let mut panel = Panel::zeros(matrix.nrows(), matrix.ncols());
        for (at, column) in matrix.as_slice().chunks_exact(matrix.nrows()).enumerate() {
            panel.set_column(at, column);
        }
        panel
    }

    /// Number of rows M.
    pub(crate) fn rows(&self) -> usize {
        self.rows
    }

    /// Replaces column `at`, (M).
    pub(crate) fn set_column(&mut self, at: usize, column: &[f64]) {
        let (height, group, lane) = (self.height(), at % ABREAST / LANES, at % LANES);
        for (row, &value) in self.numbers[at / ABREAST * height..].iter_mut().zip(column) {
            row.0[group][lane] = value;
        }
    }

    /// Sets everything to 0.
    pub(crate) fn clear(&mut self) {
        self.numbers.fill(PanelRow([[0.0; LANES]; 2]));
    }

    /// [`ABREAST`] columns at a time, and the number of groups in use.
    pub(crate) fn abreast(&mut self) -> impl Iterator<Item = (&mut [PanelRow], usize)> {
        let (height, columns) = (self.height(), self.columns);
        let parts = self.numbers.chunks_exact_mut(height).enumerate();
        parts.map(move |(part, rows)| (rows, (columns - part * ABREAST).min(ABREAST).div_ceil(LANES)))
    }

    /// Sum of squares of each column, (k).
    pub(crate) fn squared_norms(&self) -> Vec<f64> {
        let mut norms = Vec::with_capacity(self.columns);
        for part in self.numbers.chunks_exact(self.height()) {
            let mut sums = [[0.0; LANES]; 2];
            for PanelRow(row) in part {
                for (sums, numbers) in sums.iter_mut().zip(row) {
                    for lane in 0..LANES {
                        sums[lane] += numbers[lane] * numbers[lane];
                    }
                }
            }
            norms.extend(sums.as_flattened().iter().take(self.columns - norms.len()));
        }
        norms
    }

    /// The columns as a matrix, (M, k).
    pub(crate) fn into_matrix(self) -> DMatrix<f64> {
        let height = self.height();
        DMatrix::from_fn(self.rows, self.columns, |row, column| {
            self.numbers[column / ABREAST * height + row].0[column % ABREAST / LANES][column % LANES]
        })
    }

    fn height(&self) -> usize {
        self.rows.next_multiple_of(LANES)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn panels_round_trip_their_matrix(rows in 1_usize..40, columns in 1_usize..40, seed in -9.0..9.0_f64) {
            let matrix = DMatrix::from_fn(rows, columns, |i, j| (seed + (i * 41 + j) as f64).sin());
            let mut panel = Panel::of(&matrix);
            let norms: Vec<f64> = matrix.column_iter().map(|column| column.norm_squared()).collect();
            for (fast, literal) in panel.squared_norms().into_iter().zip(norms) {
                prop_assert!((fast - literal).abs() <= 1e-14 * literal);
            }
            prop_assert_eq!(panel.abreast().map(|(_, groups)| groups).sum::<usize>(), columns.div_ceil(LANES));
            prop_assert_eq!(panel.clone().into_matrix(), matrix);
            panel.clear();
            prop_assert_eq!(panel.into_matrix(), DMatrix::zeros(rows, columns));
        }
    }
}
