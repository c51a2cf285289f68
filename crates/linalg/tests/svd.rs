use linalg::{Svd, singular_values};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

use crate::drawn::{matrix, near, size};

proptest! {
    #[test]
    fn the_parts_make_the_matrix(a in size().prop_flat_map(|m| matrix(m, m))) {
        let m = a.nrows();
        let Svd { u, singular, v } = singular_values(&a).expect("finite");
        prop_assert!(singular.is_sorted_by(|a, b| a >= b) && singular[m - 1] >= 0.0);
        near(&u.tr_mul(&u), &DMatrix::identity(m, m), 1e-12)?;
        near(&v.tr_mul(&v), &DMatrix::identity(m, m), 1e-12)?;
        near(&(u * DMatrix::from_diagonal(&DVector::from_vec(singular)) * v.transpose()), &a, 1e-12)?;
    }
}

#[test]
fn nan_matrices_have_no_svd() {
    assert!(singular_values(&DMatrix::from_element(3, 3, f64::NAN)).is_none());
}
