//! Conversion of Python's arrays, with one copy.

use nalgebra::DMatrix;
use numpy::ndarray::Array2;
use numpy::{PyArray2, PyReadonlyArray2, PyUntypedArrayMethods as _};
use pyo3::prelude::*;

/// An (N, n) array as an (n, N) matrix. Another thread may write to the array while the lock is released, so it is copied
/// and nothing is computed in place.
///
/// `as_slice` also accepts Fortran order, and would then return the transpose.
pub(crate) fn matrix(array: &PyReadonlyArray2<'_, f64>) -> DMatrix<f64> {
    let (samples, dim) = (array.shape()[0], array.shape()[1]);
    let numbers = match array.as_slice() {
        Ok(numbers) if array.is_c_contiguous() => numbers.to_vec(),
        _ => array.as_array().iter().copied().collect(),
    };
    DMatrix::from_vec(dim, samples, numbers)
}

/// An (n, N) matrix as an (N, n) array.
pub(crate) fn array(py: Python<'_>, matrix: DMatrix<f64>) -> Bound<'_, PyArray2<f64>> {
    let shape = (matrix.ncols(), matrix.nrows());
    let numbers: Vec<f64> = matrix.data.into();
    let array = Array2::from_shape_vec(shape, numbers).unwrap_or_else(|_| unreachable!("as many numbers as entries"));
    PyArray2::from_owned_array(py, array)
}
