//! Random matrices for tests.

use nalgebra::DMatrix;
use proptest::collection::vec;
use proptest::prelude::*;

/// A few rows, around the number of lanes of a vector register, or more than faer's block size.
pub(crate) fn size() -> impl Strategy<Value = usize> {
    prop_oneof![1usize..10, 10usize..90]
}

/// Entries from -1 to 1.
pub(crate) fn matrix(rows: usize, columns: usize) -> impl Strategy<Value = DMatrix<f64>> {
    vec(-1.0..1.0, rows * columns).prop_map(move |entries| DMatrix::from_vec(rows, columns, entries))
}

/// Checks that shapes are equal and entries differ by less than `tolerance` times the largest entry, or 1.
pub(crate) fn near(one: &DMatrix<f64>, other: &DMatrix<f64>, tolerance: f64) -> Result<(), TestCaseError> {
    prop_assert_eq!(one.shape(), other.shape());
    let difference = (one - other).amax();
    prop_assert!(difference <= tolerance * other.amax().max(1.0), "{difference}");
    Ok(())
}
