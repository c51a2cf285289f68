use linalg::Factor;
use nalgebra::DMatrix;
use proptest::prelude::*;

use crate::drawn::{matrix, near, size};

fn lower(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    matrix.lower_triangle()
}

proptest! {
    #[test]
    fn factor_agrees_with_nalgebra(
        (a, b) in (size(), size()).prop_flat_map(|(m, c)| (matrix(m, m), matrix(m, c))), shift in 0.5..2.0,
    ) {
        let m = a.nrows();
        let k: DMatrix<f64> = &a * a.transpose() + DMatrix::identity(m, m) * shift;
        let factor = Factor::new(k.clone()).expect("positive definite");
        prop_assert_eq!(factor.len(), m);

        let literal = k.clone().cholesky().expect("positive definite");
        near(&lower(&factor.clone().into_matrix()), &literal.l(), 1e-12)?;
        prop_assert!((2.0 * factor.half_log_determinant() - literal.ln_determinant()).abs() < 1e-11);

        let (mut whitened, mut transposed, mut solved) = (b.clone(), b.clone(), b.clone());
        factor.whiten(&mut whitened);
        near(&(literal.l() * whitened), &b, 1e-12)?;
        factor.whiten_transposed(&mut transposed);
        near(&(literal.l().transpose() * transposed), &b, 1e-12)?;
        factor.solve(&mut solved);
        near(&(&k * solved), &b, 1e-11)?;
    }

    /// Only lower triangles are written, and only the lower triangle of K is read.
    #[test]
    fn inverses_are_inverse(a in size().prop_flat_map(|m| matrix(m, m)), shift in 0.5..2.0, above in -9.0..9.0) {
        let m = a.nrows();
        let k: DMatrix<f64> = &a * a.transpose() + DMatrix::identity(m, m) * shift;
        let mut half = k.clone();
        half.fill_upper_triangle(above, 1);
        let factor = Factor::new(half).expect("positive definite");
        let l = lower(&factor.clone().into_matrix());
        let triangle = factor.inverse_triangle();
        prop_assert_eq!(&triangle, &lower(&triangle));
        near(&(&l * &triangle), &DMatrix::identity(m, m), 1e-11)?;

        // Previous entries in the lower triangles are replaced; zeros above are kept.
        let mut inverse = DMatrix::from_element(m, m, above);
        let mut x = lower(&inverse);
        factor.inverse_into(&mut inverse, &mut x);
        prop_assert_eq!(x, triangle);
        inverse.fill_upper_triangle_with_lower_triangle();
        near(&(&k * inverse), &DMatrix::identity(m, m), 1e-10)?;
    }

    #[test]
    fn indefinite_and_nan_matrices_have_no_factor(a in size().prop_flat_map(|m| matrix(m, m)), at in 0usize..40) {
        let m = a.nrows();
        let mut k = &a * a.transpose() + DMatrix::identity(m, m);
        k[(at % m, at % m)] = -1.0;
        prop_assert!(Factor::new(k.clone()).is_none());
        k[(at % m, at % m)] = f64::NAN;
        prop_assert!(Factor::new(k).is_none());
    }
}
