//! Compares gradient and Hessian of the prediction with central differences.

use crate::support::case;
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

const STEP: f64 = 1e-5;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    #[test]
    fn gradient_and_hessian_are_derivatives(case in case(250), at in 0_usize..250, output in 0_usize..3) {
        let (n, output) = (case.n_in, output % case.n_out);
        // Without a cutoff the prediction is smooth (the second derivative of the bisquare kernel jumps at its border).
        let predictor = case.trained(2).predictor(0.0);
        let x = case.xs.column(at).into_owned();
        let gradient_at = |x: &DVector<f64>| {
            let mut gradient = DVector::zeros(n);
            predictor.value_and_gradient_into(x.as_view(), output, gradient.as_view_mut()).map(|_| gradient)
        };
        let Some(gradient) = gradient_at(&x) else { return Ok(()) };
        let hessian = predictor.hessian(x.as_view(), output).unwrap();
        // There is a joint prediction of all outputs only if each has support.
        if let Some(p) = predictor.predict(x.as_view()) {
            prop_assert_eq!(p.gradient.row(output).transpose(), gradient.clone());
        }

        let (mut slope, mut curvature) = (DVector::zeros(n), DMatrix::zeros(n, n));
        for i in 0..n {
            let step = DVector::from_fn(n, |k, _| if k == i { STEP } else { 0.0 });
            let (right, left) = (&x + &step, &x - &step);
            let (Some(up), Some(down)) = (gradient_at(&right), gradient_at(&left)) else { return Ok(()) };
            let value = |x: &DVector<f64>| predictor.value(x.as_view(), output).unwrap();
            slope[i] = (value(&right) - value(&left)) / (2.0 * STEP);
            let change = up - down;
            curvature.set_column(i, &(change / (2.0 * STEP)));
        }
        prop_assert!((&slope - &gradient).amax() <= 1e-5 * (1.0 + gradient.amax()), "{slope} {gradient}");
        let smooth = case.params.kernel == lwpr::Kernel::Gaussian;
        let error = (&curvature - &hessian).amax();
        prop_assert!(!smooth || error <= 1e-4 * (1.0 + hessian.amax()), "{curvature} {hessian}");
    }
}
