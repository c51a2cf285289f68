//! Leave-one-trajectory-out prediction, which selects the noise and tests for a potential.

pub(crate) mod common_error;
pub(crate) mod comparison;
pub(crate) mod curl_test;
pub(crate) mod level;
pub(crate) mod typical;
pub(crate) mod weights_test;

use linalg::{Factor, transposed_product};
use nalgebra::DMatrix;
use rayon::prelude::*;

/// Leave-one-trajectory-out predictions in closed form, (S10), (S11), (R3).
#[derive(Debug, Clone, PartialEq)]
pub struct LeftOutPredictions {
    /// y minus its prediction without the row's trajectory, (M, c), scaled.
    pub residuals: DMatrix<f64>,
    /// Variance of that prediction, (M), scaled.
    pub variances: Vec<f64>,
    /// R² = 1 − Σ w|e|² / spread.
    pub r_squared: f64,
    /// Mean of e²/v: 1 if the noise model is right.
    pub z_squared: f64,
}

/// Held-out error, as a share of the variance, below which prediction cannot distinguish any further.
const EXACT: f64 = 1e-8;
/// Held-out error below which differences between models are insignificant and a model's family is not in question.
pub(crate) const NEARLY_EXACT: f64 = 1e-3;

impl LeftOutPredictions {
    /// (S11) for residuals (M, c) and their variances (M); `None` if they are not finite.
    pub(crate) fn of(
        residuals: DMatrix<f64>,
        variances: Vec<f64>,
        noise_weights: &[f64],
        spread: f64,
    ) -> Option<LeftOutPredictions> {
        let squares: Vec<f64> = residuals.row_iter().map(|row| row.norm_squared()).collect();
        let weighted: f64 = squares.iter().zip(noise_weights).map(|(square, weight)| square / weight).sum();
        let standardised: f64 = squares.iter().zip(&variances).map(|(square, variance)| square / variance).sum();
        let r_squared = 1.0 - weighted / spread;
        let z_squared = standardised / residuals.len() as f64;
        let finite = r_squared.is_finite() && z_squared.is_finite();
        finite.then_some(LeftOutPredictions { residuals, variances, r_squared, z_squared })
    }

    /// Reorders the rows: `rows`, (M), gives the position of each among all.
    pub(crate) fn at(self, rows: &[usize]) -> LeftOutPredictions {
        let mut placed = self.clone();
        for (at, &row) in rows.iter().enumerate() {
            placed.residuals.row_mut(row).copy_from(&self.residuals.row(at));
            placed.variances[row] = self.variances[at];
        }
        placed
    }

    /// Whether prediction is so good that more noise and other families need not be tried.
    pub(crate) fn is_exact(&self) -> bool {
        1.0 - self.r_squared < EXACT
    }

    /// Whether prediction is so good that it does not distinguish models.
    pub(crate) fn is_nearly_exact(&self) -> bool {
        is_nearly_exact(self.r_squared)
    }
}

/// Whether a held-out R² is so large that it does not distinguish models.
pub(crate) fn is_nearly_exact(r_squared: f64) -> bool {
    1.0 - r_squared <= NEARLY_EXACT
}

/// For each group of rows T: V_T = ((K⁻¹)_TT)⁻¹ and e_T = V_T α_T, with (K⁻¹)_TT = X_Tᵀ X_T and X = L⁻¹, (M, M), zero above
/// the diagonal. `None` if a block cannot be inverted.
///
/// `spread` is Σ w|y|² about the prediction without a model.
pub(crate) fn left_out(
    x: &DMatrix<f64>,
    weights: &DMatrix<f64>,
    groups: &[Vec<usize>],
    noise_weights: &[f64],
    spread: f64,
) -> Option<LeftOutPredictions> {
    let blocks: Vec<_> = groups.par_iter().map(|rows| block(x, weights, rows)).collect();
    let mut residuals = DMatrix::zeros(weights.nrows(), weights.ncols());
    let mut variances = vec![0.0; weights.nrows()];
    for (rows, block) in groups.iter().zip(blocks) {
        let (errors, block_variances) = block?;
        for (at, &row) in rows.iter().enumerate() {
            residuals.row_mut(row).copy_from(&errors.row(at));
            variances[row] = block_variances[at];
        }
    }
    LeftOutPredictions::of(residuals, variances, noise_weights, spread)
}

/// e_T and the diagonal of V_T.
fn block(x: &DMatrix<f64>, weights: &DMatrix<f64>, rows: &[usize]) -> Option<(DMatrix<f64>, Vec<f64>)> {
    // L⁻¹ is zero above the first of these rows.
    let first = *rows.iter().min()?;
    let columns = x.rows_range(first..).select_columns(rows);
    let factor = Factor::new(transposed_product(&columns, &columns))?;
    let mut errors = weights.select_rows(rows);
    factor.solve(&mut errors);
    let inverse = factor.inverse_triangle();
    let variances = inverse.column_iter().map(|column| column.norm_squared()).collect();
    Some((errors, variances))
}
