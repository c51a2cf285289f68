use nalgebra::{DMatrix, DVector};

/// Every row of `values`, (n, N), times its factor, (n).
pub fn scaled(values: &DMatrix<f64>, factors: &DVector<f64>) -> DMatrix<f64> {
    let mut values = values.clone();
    values.column_iter_mut().for_each(|mut column| column.component_mul_assign(factors));
    values
}
