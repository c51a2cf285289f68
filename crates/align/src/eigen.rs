use faer::diag::DiagMut;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd::{ComputeEigenvectors, self_adjoint_evd, self_adjoint_evd_scratch};
use faer::{MatMut, MatRef, Par, Spec};
use nalgebra::DMatrix;

use crate::AlignError;

/// Ascending eigenvalues of a symmetric matrix, of which the lower triangle is read, and its eigenvectors as columns.
pub(crate) fn symmetric_eigen(matrix: &DMatrix<f64>) -> Result<(Vec<f64>, DMatrix<f64>), AlignError> {
    let n = matrix.ncols();
    let mut values = vec![0.0; n];
    let mut vectors = DMatrix::zeros(n, n);
    let scratch = self_adjoint_evd_scratch::<f64>(n, ComputeEigenvectors::Yes, Par::Seq, Spec::default());
    self_adjoint_evd(
        MatRef::from_column_major_slice(matrix.as_slice(), n, n),
        DiagMut::from_slice_mut(&mut values),
        Some(MatMut::from_column_major_slice_mut(vectors.as_mut_slice(), n, n)),
        Par::Seq,
        MemStack::new(&mut MemBuffer::new(scratch)),
        Spec::default(),
    )
    .map_err(|_| AlignError::NoConvergence)?;
    Ok((values, vectors))
}
