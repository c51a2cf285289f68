use linalg::{symmetric_eigen, symmetric_eigenvalues};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

use crate::drawn::{matrix, near, size};

proptest! {
    #[test]
    fn the_parts_make_the_matrix(a in size().prop_flat_map(|m| matrix(m, m)), above in -9.0..9.0) {
        let symmetric = &a + a.transpose();
        let mut half = symmetric.clone();
        half.fill_upper_triangle(above, 1);
        let (values, vectors) = symmetric_eigen(&half).expect("convergence");
        prop_assert!(values.is_sorted());
        let n = a.nrows();
        near(&vectors.tr_mul(&vectors), &DMatrix::identity(n, n), 1e-12)?;
        let alone = symmetric_eigenvalues(&half).expect("convergence");
        near(&DMatrix::from_vec(n, 1, alone), &DMatrix::from_vec(n, 1, values.clone()), 1e-12)?;
        let product = &vectors * DMatrix::from_diagonal(&DVector::from_vec(values)) * vectors.transpose();
        near(&product, &symmetric, 1e-12)?;
    }
}
