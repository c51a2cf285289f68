use linalg::{gram, subtract_gram, subtract_outer, transposed_product, transposed_product_of_rows};
use nalgebra::DMatrix;
use proptest::prelude::*;

use crate::drawn::{matrix, near, size};

proptest! {
    /// Includes products with some or none of the rows of A.
    #[test]
    fn products_are_those_of_nalgebra(
        (a, b) in (size(), size(), size()).prop_flat_map(|(m, k, c)| (matrix(m, k), matrix(m, c))), count in 0usize..90,
    ) {
        let (stride, count) = (a.nrows(), count.min(a.nrows()));
        near(&transposed_product(&a, &b), &a.tr_mul(&b), 1e-13)?;
        let part = b.rows(0, count).into_owned();
        near(&transposed_product_of_rows(a.as_slice(), stride, &part), &a.rows(0, count).tr_mul(&part), 1e-13)?;
        near(&gram(a.as_slice(), stride), &a.tr_mul(&a).lower_triangle(), 1e-13)?;
    }

    #[test]
    fn products_are_subtracted_below_the_diagonal(
        (b, small, large) in (size(), size()).prop_flat_map(|(m, k)| (matrix(m, k), matrix(k, k), matrix(m, m))),
    ) {
        let literal = |of: &DMatrix<f64>, product: DMatrix<f64>| of - product.lower_triangle();
        let (mut less_gram, mut less_outer) = (small.clone(), large.clone());
        subtract_gram(&mut less_gram, &b);
        near(&less_gram, &literal(&small, b.tr_mul(&b)), 1e-13)?;
        subtract_outer(&mut less_outer, &b);
        near(&less_outer, &literal(&large, &b * b.transpose()), 1e-13)?;
    }
}
