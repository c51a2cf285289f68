use linalg::qr_triangle;
use proptest::prelude::*;

use crate::drawn::{matrix, near, size};

proptest! {
    #[test]
    fn the_triangle_has_the_products_of_the_matrix(a in (size(), size()).prop_flat_map(|(m, c)| matrix(m, c))) {
        let r = qr_triangle(a.clone());
        prop_assert_eq!(&r, &r.upper_triangle());
        near(&r.tr_mul(&r), &a.tr_mul(&a), 1e-12)?;
    }
}
