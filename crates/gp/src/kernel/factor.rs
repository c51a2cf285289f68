//! Cholesky factors, by faer on one thread: the same bits at any number of threads.

use std::sync::OnceLock;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{LltRegularization, cholesky_in_place, cholesky_in_place_scratch};
use faer::linalg::matmul::triangular::{BlockStructure, matmul};
use faer::linalg::triangular_inverse::invert_lower_triangular;
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_upper_triangular_in_place};
use faer::{Accum, MatMut, MatRef, Par, Spec};
use nalgebra::DMatrix;

use crate::kernel::panel::Panel;
use crate::kernel::triangle::InverseOfLower;

/// L with K = LLᵀ, in the lower triangle; above it stands nothing of meaning.
#[derive(Debug, Clone)]
pub(crate) struct Factor {
    lower: DMatrix<f64>,
}

pub(crate) fn view(matrix: &DMatrix<f64>) -> MatRef<'_, f64> {
    MatRef::from_column_major_slice(matrix.as_slice(), matrix.nrows(), matrix.ncols())
}

pub(crate) fn view_mut(matrix: &mut DMatrix<f64>) -> MatMut<'_, f64> {
    let (rows, columns) = matrix.shape();
    MatMut::from_column_major_slice_mut(matrix.as_mut_slice(), rows, columns)
}

impl Factor {
    /// Of a symmetric matrix, of which the lower triangle is read; none if it is not positive definite in f64.
    pub(crate) fn new(mut matrix: DMatrix<f64>) -> Option<Self> {
        let scratch = cholesky_in_place_scratch::<f64>(matrix.nrows(), Par::Seq, Spec::default());
        let mut memory = MemBuffer::new(scratch);
        let stack = MemStack::new(&mut memory);
        cholesky_in_place(view_mut(&mut matrix), LltRegularization::default(), Par::Seq, stack, Spec::default())
            .ok()?;
        let sound = matrix.diagonal().iter().all(|&pivot| pivot > 0.0 && pivot.is_finite());
        sound.then_some(Factor { lower: matrix })
    }

    pub(crate) fn len(&self) -> usize {
        self.lower.nrows()
    }

    /// Σ log L_ii.
    pub(crate) fn half_log_determinant(&self) -> f64 {
        self.lower.diagonal().iter().map(|pivot| pivot.ln()).sum()
    }

    /// Replaces B by L⁻¹B.
    pub(crate) fn whiten(&self, b: &mut DMatrix<f64>) {
        solve_lower_triangular_in_place(view(&self.lower), view_mut(b), Par::Seq);
    }

    /// Replaces B by L⁻ᵀB.
    pub(crate) fn whiten_transposed(&self, b: &mut DMatrix<f64>) {
        solve_upper_triangular_in_place(view(&self.lower).transpose(), view_mut(b), Par::Seq);
    }

    /// Replaces B by K⁻¹B.
    pub(crate) fn solve(&self, b: &mut DMatrix<f64>) {
        self.whiten(b);
        self.whiten_transposed(b);
    }

    /// L, for its memory.
    pub(crate) fn into_matrix(self) -> DMatrix<f64> {
        self.lower
    }

    /// X = L⁻¹, zero above the diagonal.
    pub(crate) fn inverse_triangle(&self) -> DMatrix<f64> {
        let mut inverse = DMatrix::zeros(self.len(), self.len());
        self.inverse_triangle_into(&mut inverse);
        inverse
    }

    /// Writes the lower triangle of X = L⁻¹.
    pub(crate) fn inverse_triangle_into(&self, x: &mut DMatrix<f64>) {
        invert_lower_triangular(view_mut(x), view(&self.lower), Par::Seq);
    }

    /// Writes the lower triangles of K⁻¹ and, on the way, of X = L⁻¹.
    pub(crate) fn inverse_into(&self, inverse: &mut DMatrix<f64>, x: &mut DMatrix<f64>) {
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

/// The factor of a model's covariance: at hand after a fit; of a stored model computed when an error bar first needs it,
/// which costs M² numbers of memory for a moment, half of them for good, and M³ of time.
#[derive(Debug, Clone, Default)]
pub(crate) struct LazyFactor(OnceLock<Option<InverseOfLower>>);

impl From<Factor> for LazyFactor {
    fn from(factor: Factor) -> Self {
        LazyFactor(OnceLock::from(Some(InverseOfLower::new(&factor.lower))))
    }
}

impl LazyFactor {
    /// Replaces B by L⁻¹B. If the covariance has no factor, B becomes 0: rows that cannot be told apart say nothing, and
    /// the prior remains.
    pub(crate) fn whiten(&self, b: &mut Panel, covariance: impl FnOnce() -> DMatrix<f64>) {
        let factor = || Factor::new(covariance()).map(|factor| InverseOfLower::new(&factor.lower));
        match self.0.get_or_init(factor) {
            Some(factor) => factor.apply(b),
            None => b.clear(),
        }
    }
}

/// Adds `scale` · BᵀB or BBᵀ to the lower triangle of `target`: `left` times `right`.
pub(crate) fn add_product_below(target: &mut DMatrix<f64>, scale: f64, left: MatRef<'_, f64>, right: MatRef<'_, f64>) {
    matmul(
        view_mut(target),
        BlockStructure::TriangularLower,
        Accum::Add,
        left,
        BlockStructure::Rectangular,
        right,
        BlockStructure::Rectangular,
        scale,
        Par::Seq,
    );
}
