use faer::diag::DiagMut;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd::{ComputeEigenvectors, self_adjoint_evd, self_adjoint_evd_scratch};
use faer::{MatMut, MatRef, Par, Spec};
use nalgebra::DMatrix;

use crate::AlignError;

/// Ascending eigenvalues of a symmetric matrix, of which the lower triangle is read, and its eigenvectors as columns.
pub(crate) fn symmetric_eigen(matrix: &DMatrix<f64>) -> Result<(Vec<f64>, DMatrix<f64>), AlignError> {
    let mut vectors = DMatrix::zeros(matrix.ncols(), matrix.ncols());
    let values = decompose(matrix, Some(&mut vectors))?;
    Ok((values, vectors))
}

/// Ascending eigenvalues of a symmetric matrix, of which the lower triangle is read: half the work of the vectors too.
pub(crate) fn symmetric_eigenvalues(matrix: &DMatrix<f64>) -> Result<Vec<f64>, AlignError> {
    decompose(matrix, None)
}

fn decompose(matrix: &DMatrix<f64>, vectors: Option<&mut DMatrix<f64>>) -> Result<Vec<f64>, AlignError> {
    let n = matrix.ncols();
    let mut values = vec![0.0; n];
    let wanted = if vectors.is_some() { ComputeEigenvectors::Yes } else { ComputeEigenvectors::No };
    let scratch = self_adjoint_evd_scratch::<f64>(n, wanted, Par::Seq, Spec::default());
    self_adjoint_evd(
        MatRef::from_column_major_slice(matrix.as_slice(), n, n),
        DiagMut::from_slice_mut(&mut values),
        vectors.map(|vectors| MatMut::from_column_major_slice_mut(vectors.as_mut_slice(), n, n)),
        Par::Seq,
        MemStack::new(&mut MemBuffer::new(scratch)),
        Spec::default(),
    )
    .map_err(|_| AlignError::NoConvergence)?;
    Ok(values)
}
