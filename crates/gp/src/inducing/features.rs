//! Covariances of rows with the inducing rows, each divided by the square root of its noise weight.

use std::ops::Range;

use linalg::transposed_product;
use nalgebra::DMatrix;

use crate::kernel::covariance::Covariance;
use crate::left_out::level::Targets;

/// A prior, the inducing rows, and the data of all rows.
#[derive(Debug)]
pub(crate) struct Features<'a, C> {
    pub(crate) covariance: &'a C,
    pub(crate) amplitudes: &'a [f64],
    /// Indices of the inducing rows, (m).
    pub(crate) inducing: Vec<usize>,
    pub(crate) targets: &'a Targets,
}

impl<C: Covariance> Features<'_, C> {
    /// [D^{-1/2} K_nm | D^{-1/2} Y] of these rows, (n, m + c).
    pub(crate) fn with_targets(&self, rows: Range<usize>) -> DMatrix<f64> {
        let (count, targets) = (self.inducing.len(), &self.targets.values);
        let rows: Vec<usize> = rows.collect();
        let mut both = DMatrix::zeros(rows.len(), count + targets.ncols());
        both.columns_mut(0, count).tr_copy_from(&self.transposed(&rows));
        both.columns_mut(count, targets.ncols()).copy_from(&self.whitened_targets(&rows));
        both
    }

    /// D^{-1/2} Y of these rows, (n, c).
    pub(crate) fn whitened_targets(&self, rows: &[usize]) -> DMatrix<f64> {
        let mut targets = self.targets.values.select_rows(rows);
        for (mut target, &row) in targets.row_iter_mut().zip(rows) {
            target *= self.weight(row);
        }
        targets
    }

    /// D^{-1/2} K_nm W of these rows, (n, k), with W, (m, k).
    pub(crate) fn times(&self, rows: &[usize], w: &DMatrix<f64>) -> DMatrix<f64> {
        transposed_product(&self.transposed(rows), w)
    }

    /// D^{-1/2}.
    fn weight(&self, row: usize) -> f64 {
        1.0 / self.targets.noise_weights[row].sqrt()
    }

    /// (D^{-1/2} K_nm)ᵀ of these rows, (m, n).
    fn transposed(&self, rows: &[usize]) -> DMatrix<f64> {
        let with = self.covariance.with(&self.inducing, self.amplitudes);
        let mut covariances = DMatrix::zeros(self.inducing.len(), rows.len());
        for (mut column, &row) in covariances.column_iter_mut().zip(rows) {
            with(row, column.as_mut_slice());
            column *= self.weight(row);
        }
        covariances
    }
}
