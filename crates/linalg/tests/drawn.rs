//! Matrices that tests draw.

use nalgebra::DMatrix;
use proptest::collection::vec;
use proptest::prelude::*;

/// Few rows, as many as a vector register has lanes and one more, or more than faer divides.
pub(crate) fn size() -> impl Strategy<Value = usize> {
    prop_oneof![1usize..10, 10usize..90]
}

/// Entries of -1 to 1.
pub(crate) fn matrix(rows: usize, columns: usize) -> impl Strategy<Value = DMatrix<f64>> {
    vec(-1.0..1.0, rows * columns).prop_map(move |entries| DMatrix::from_vec(rows, columns, entries))
}

/// Equal shapes, and entries that differ by less than `tolerance` times the largest, or 1.
pub(crate) fn near(one: &DMatrix<f64>, other: &DMatrix<f64>, tolerance: f64) -> Result<(), TestCaseError> {
    prop_assert_eq!(one.shape(), other.shape());
    let difference = (one - other).amax();
    prop_assert!(difference <= tolerance * other.amax().max(1.0), "{difference}");
    Ok(())
}
