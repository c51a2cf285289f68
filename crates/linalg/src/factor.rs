use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{LltRegularization, cholesky_in_place, cholesky_in_place_scratch};
use faer::linalg::matmul::triangular::{BlockStructure, matmul};
use faer::linalg::triangular_inverse::invert_lower_triangular;
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_upper_triangular_in_place};
use faer::{Accum, Par, Spec};
use nalgebra::DMatrix;

use crate::view::{view, view_mut};

/// The Cholesky factor L of a positive definite K = LLᵀ, (M, M), in the lower triangle; the entries above it are
/// meaningless.
#[derive(Debug, Clone)]
pub struct Factor {
    lower: DMatrix<f64>,
}

impl Factor {
    /// Factorizes a symmetric matrix, of which only the lower triangle is read; `None` if it is not positive definite in
    /// f64. M³/3 operations.
    pub fn new(mut matrix: DMatrix<f64>) -> Option<Self> {
        let scratch = cholesky_in_place_scratch::<f64>(matrix.nrows(), Par::Seq, Spec::default());
        let mut memory = MemBuffer::new(scratch);
        let stack = MemStack::new(&mut memory);
        cholesky_in_place(view_mut(&mut matrix), LltRegularization::default(), Par::Seq, stack, Spec::default())
            .ok()?;
        let sound = matrix.diagonal().iter().all(|&pivot| pivot > 0.0 && pivot.is_finite());
        sound.then_some(Factor { lower: matrix })
    }

    /// Number M of rows.
    #[expect(clippy::len_without_is_empty, reason = "the number of rows of a matrix")]
    pub fn len(&self) -> usize {
        self.lower.nrows()
    }

    /// Σ log L_ii.
    pub fn half_log_determinant(&self) -> f64 {
        self.lower.diagonal().iter().map(|pivot| pivot.ln()).sum()
    }

    /// Replaces B, (M, c), by L⁻¹B.
    pub fn whiten(&self, b: &mut DMatrix<f64>) {
        solve_lower_triangular_in_place(view(&self.lower), view_mut(b), Par::Seq);
    }

    /// Replaces B, (M, c), by L⁻ᵀB.
    pub fn whiten_transposed(&self, b: &mut DMatrix<f64>) {
        solve_upper_triangular_in_place(view(&self.lower).transpose(), view_mut(b), Par::Seq);
    }

    /// Replaces B, (M, c), by K⁻¹B.
    pub fn solve(&self, b: &mut DMatrix<f64>) {
        self.whiten(b);
        self.whiten_transposed(b);
    }

    /// L, to reuse its memory; the entries above the diagonal are meaningless.
    pub fn into_matrix(self) -> DMatrix<f64> {
        self.lower
    }

    /// X = L⁻¹, zero above the diagonal.
    pub fn inverse_triangle(&self) -> DMatrix<f64> {
        let mut inverse = DMatrix::zeros(self.len(), self.len());
        self.inverse_triangle_into(&mut inverse);
        inverse
    }

    /// Writes the lower triangle of X = L⁻¹, (M, M).
    pub fn inverse_triangle_into(&self, x: &mut DMatrix<f64>) {
        invert_lower_triangular(view_mut(x), view(&self.lower), Par::Seq);
    }

    /// Writes the lower triangles of K⁻¹ and of the intermediate result X = L⁻¹, both (M, M).
    pub fn inverse_into(&self, inverse: &mut DMatrix<f64>, x: &mut DMatrix<f64>) {
        self.inverse_triangle_into(x);
        matmul(
            view_mut(inverse),
            BlockStructure::TriangularLower,
            Accum::Replace,
            view(x).transpose(),
            BlockStructure::TriangularUpper,
            view(x),
            BlockStructure::TriangularLower,
            1.0,
            Par::Seq,
        );
    }
}
