use faer::linalg::matmul::matmul;
use faer::linalg::matmul::triangular::{BlockStructure, matmul as matmul_of_parts};
use faer::{Accum, MatRef, Par};
use nalgebra::DMatrix;

use crate::view::{view, view_mut};

/// AᵀB, (k, c), of A, (M, k), and B, (M, c).
pub fn transposed_product(a: &DMatrix<f64>, b: &DMatrix<f64>) -> DMatrix<f64> {
    assert_eq!(a.nrows(), b.nrows(), "AᵀB needs as many rows of A as of B");
    transposed_product_of_rows(a.as_slice(), a.nrows(), b)
}

/// AᵀB, (k, c), of B, (M, c), and A, (M, k). Each column of A is the first M of `stride` numbers.
pub fn transposed_product_of_rows(columns: &[f64], stride: usize, b: &DMatrix<f64>) -> DMatrix<f64> {
    let a = MatRef::from_column_major_slice(columns, stride, columns.len() / stride).subrows(0, b.nrows());
    let mut product = DMatrix::zeros(a.ncols(), b.ncols());
    matmul(view_mut(&mut product), Accum::Replace, a.transpose(), view(b), 1.0, Par::Seq);
    product
}

/// AᵀA, (k, k), of A, (rows, k), given column by column; the lower triangle, with zeros above.
pub fn gram(columns: &[f64], rows: usize) -> DMatrix<f64> {
    let a = MatRef::from_column_major_slice(columns, rows, columns.len() / rows);
    let mut gram = DMatrix::zeros(a.ncols(), a.ncols());
    lower_triangle(&mut gram, Accum::Replace, 1.0, a.transpose(), a);
    gram
}

/// Subtracts BᵀB of B, (M, k), from the lower triangle of `target`, (k, k).
pub fn subtract_gram(target: &mut DMatrix<f64>, b: &DMatrix<f64>) {
    let b = view(b);
    lower_triangle(target, Accum::Add, -1.0, b.transpose(), b);
}

/// Subtracts BBᵀ of B, (M, k), from the lower triangle of `target`, (M, M).
pub fn subtract_outer(target: &mut DMatrix<f64>, b: &DMatrix<f64>) {
    let b = view(b);
    lower_triangle(target, Accum::Add, -1.0, b, b.transpose());
}

fn lower_triangle(
    target: &mut DMatrix<f64>,
    accumulate: Accum,
    scale: f64,
    left: MatRef<'_, f64>,
    right: MatRef<'_, f64>,
) {
    let (lower, whole) = (BlockStructure::TriangularLower, BlockStructure::Rectangular);
    matmul_of_parts(view_mut(target), lower, accumulate, left, whole, right, whole, scale, Par::Seq);
}
