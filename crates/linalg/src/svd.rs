use faer::diag::Diag;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::svd::{ComputeSvdVectors, svd, svd_scratch};
use faer::{Par, Spec};
use nalgebra::DMatrix;

use crate::view::{view, view_mut};

/// A = U diag(s) Vᵀ of a square matrix, (m, m).
#[derive(Debug, Clone)]
pub struct Svd {
    /// U, (m, m).
    pub u: DMatrix<f64>,
    /// s, (m), descending.
    pub singular: Vec<f64>,
    /// V, (m, m).
    pub v: DMatrix<f64>,
}

/// Singular values and vectors of a square matrix, (m, m). `None` if the iteration does not converge, or converges to
/// non-finite numbers.
pub fn singular_values(matrix: &DMatrix<f64>) -> Option<Svd> {
    let count = matrix.nrows();
    let vectors = ComputeSvdVectors::Full;
    let mut memory = MemBuffer::new(svd_scratch::<f64>(count, count, vectors, vectors, Par::Seq, Spec::default()));
    let [mut u, mut v] = [(); 2].map(|()| DMatrix::zeros(count, count));
    let mut singular = Diag::<f64>::zeros(count);
    let stack = MemStack::new(&mut memory);
    let (u_view, v_view) = (Some(view_mut(&mut u)), Some(view_mut(&mut v)));
    svd(view(matrix), singular.as_mut(), u_view, v_view, Par::Seq, stack, Spec::default()).ok()?;
    let singular: Vec<f64> = singular.column_vector().iter().copied().collect();
    singular.iter().all(|s| s.is_finite()).then_some(Svd { u, singular, v })
}
