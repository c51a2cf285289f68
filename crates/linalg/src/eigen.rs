use faer::diag::DiagMut;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd::{ComputeEigenvectors, self_adjoint_evd, self_adjoint_evd_scratch};
use faer::{Par, Spec};
use nalgebra::DMatrix;

use crate::view::{view, view_mut};

/// Ascending eigenvalues (n) of a symmetric matrix, of which only the lower triangle is read, and its eigenvectors as columns, (n, n).
/// `None` if the iteration does not converge.
pub fn symmetric_eigen(matrix: &DMatrix<f64>) -> Option<(Vec<f64>, DMatrix<f64>)> {
    let mut vectors = DMatrix::zeros(matrix.ncols(), matrix.ncols());
    let values = decompose(matrix, Some(&mut vectors))?;
    Some((values, vectors))
}

/// Ascending eigenvalues (n) of a symmetric matrix, of which only the lower triangle is read; half the work of computing eigenvectors as
/// well. `None` if the iteration does not converge.
pub fn symmetric_eigenvalues(matrix: &DMatrix<f64>) -> Option<Vec<f64>> {
    decompose(matrix, None)
}

fn decompose(matrix: &DMatrix<f64>, vectors: Option<&mut DMatrix<f64>>) -> Option<Vec<f64>> {
    let n = matrix.ncols();
    let mut values = vec![0.0; n];
    let wanted = if vectors.is_some() { ComputeEigenvectors::Yes } else { ComputeEigenvectors::No };
    let scratch = self_adjoint_evd_scratch::<f64>(n, wanted, Par::Seq, Spec::default());
    self_adjoint_evd(
        view(matrix),
        DiagMut::from_slice_mut(&mut values),
        vectors.map(view_mut),
        Par::Seq,
        MemStack::new(&mut MemBuffer::new(scratch)),
        Spec::default(),
    )
    .ok()?;
    Some(values)
}
