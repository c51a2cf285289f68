//! Input without a defined error is refused, with the place of the fault; results are never NaN.

use metrics::{MetricsError, Series, Summary, ncpe, nupe, potential_nmse};
use nalgebra::{DMatrix, DVector, dmatrix, dvector};
use proptest::prelude::*;

fn not_finite(series: Series, sample: usize, dimension: usize, value: f64) -> MetricsError {
    MetricsError::NotFinite { series, sample, dimension, value }
}

#[test]
fn policies() {
    let good = dmatrix![1.0, 2.0, 3.0; 0.0, 1.0, 0.0];
    let with = |value: f64| {
        let mut policy = good.clone();
        policy[(1, 2)] = value;
        policy
    };
    let inf = f64::INFINITY;
    let cases = [
        (DMatrix::zeros(2, 0), DMatrix::zeros(2, 0), MetricsError::Empty { rows: 2, columns: 0 }),
        (DMatrix::zeros(0, 3), DMatrix::zeros(0, 3), MetricsError::Empty { rows: 0, columns: 3 }),
        (good.clone(), DMatrix::zeros(2, 4), MetricsError::Shape { truth: (2, 3), learnt: (2, 4) }),
        (good.clone(), DMatrix::zeros(3, 2), MetricsError::Shape { truth: (2, 3), learnt: (3, 2) }),
        (DMatrix::zeros(2, 0), good.clone(), MetricsError::Shape { truth: (2, 0), learnt: (2, 3) }),
        (with(inf), good.clone(), not_finite(Series::Truth, 2, 1, inf)),
        (good.clone(), with(-inf), not_finite(Series::Learnt, 2, 1, -inf)),
        (good.clone(), &good * 1e200, MetricsError::Overflow),
        (&good * 1e-300, &good * 1e300, MetricsError::Overflow),
        (
            DMatrix::zeros(2, 3),
            good.clone(),
            MetricsError::ConstantTruth { samples: 3, magnitude: 0.0, deviation: 0.0 },
        ),
        (
            dmatrix![3.0; 4.0],
            dmatrix![1.0; 1.0],
            MetricsError::ConstantTruth { samples: 1, magnitude: 5.0, deviation: 0.0 },
        ),
    ];
    for (truth, learnt, expected) in cases {
        assert_eq!(nupe(&truth, &learnt).unwrap_err(), expected);
        assert_eq!(ncpe(&truth, &learnt, |_, _| {}).unwrap_err(), expected);
    }
    let error = nupe(&with(f64::NAN), &good).unwrap_err();
    assert!(
        matches!(error, MetricsError::NotFinite { series: Series::Truth, sample: 2, dimension: 1, value } if value.is_nan())
    );
    let error = ncpe(&good, &good, |sample, mut difference| difference[1] = if sample == 1 { inf } else { 0.0 });
    assert_eq!(error.unwrap_err(), not_finite(Series::Projected, 1, 1, inf));
}

#[test]
fn potentials() {
    let good = dvector![1.0, 2.0, 4.0];
    let inf = f64::INFINITY;
    let cases = [
        (DVector::zeros(0), DVector::zeros(0), MetricsError::Empty { rows: 1, columns: 0 }),
        (good.clone(), dvector![1.0, 2.0], MetricsError::Shape { truth: (1, 3), learnt: (1, 2) }),
        (dvector![1.0, inf, 2.0], good.clone(), not_finite(Series::Truth, 1, 0, inf)),
        (good.clone(), dvector![1.0, 2.0, inf], not_finite(Series::Learnt, 2, 0, inf)),
        (good.clone(), dvector![1e200, -1e200, 0.0], MetricsError::Overflow),
        (good.clone(), dvector![f64::MAX, -f64::MAX, 0.0], MetricsError::Overflow),
        (
            dvector![-7.0, -7.0, -7.0],
            good.clone(),
            MetricsError::ConstantTruth { samples: 3, magnitude: 7.0, deviation: 0.0 },
        ),
    ];
    for (truth, learnt, expected) in cases {
        assert_eq!(potential_nmse(&truth, &learnt).unwrap_err(), expected);
    }
}

#[test]
fn summaries() {
    assert_eq!(Summary::of(&[]).unwrap_err(), MetricsError::Empty { rows: 1, columns: 0 });
    let inf = f64::INFINITY;
    assert_eq!(Summary::of(&[1.0, inf]).unwrap_err(), not_finite(Series::Errors, 1, 0, inf));
    assert!(matches!(Summary::of(&[f64::NAN]), Err(MetricsError::NotFinite { sample: 0, .. })));
    for values in [[f64::MAX, f64::MAX], [1e300, -1e300]] {
        assert_eq!(Summary::of(&values).unwrap_err(), MetricsError::Overflow);
    }
}

proptest! {
    #[test]
    fn constant_up_to_rounding_is_constant(
        constant in prop_oneof![-1.0..1.0f64, -1e-200..1e-200f64, -1e200..1e200f64],
        ulps in proptest::collection::vec(-8.0..8.0f64, 1..3000),
    ) {
        prop_assume!(constant.abs() > f64::MIN_POSITIVE / f64::EPSILON);
        let phi = DVector::from_iterator(ulps.len(), ulps.iter().map(|ulp| constant * (1.0 + ulp.round() * f64::EPSILON)));
        let error = potential_nmse(&phi, &phi).unwrap_err();
        prop_assert!(matches!(error, MetricsError::ConstantTruth { .. }), "{}", error);
        let policy = DMatrix::from_row_slice(1, phi.len(), phi.as_slice());
        prop_assert_eq!(nupe(&policy, &policy).unwrap_err(), error);
    }

    #[test]
    fn small_variations_are_scored(constant in 0.1..10.0f64, exponent in -10.0..-3.0f64) {
        let phi = dvector![constant, constant * (1.0 + 10f64.powf(exponent))];
        prop_assert!(potential_nmse(&phi, &phi).unwrap() == 0.0);
        let reversed = dvector![phi[1], phi[0]];
        // With the order reversed, the error is twice the deviation.
        prop_assert!((potential_nmse(&phi, &reversed).unwrap() - 4.0).abs() < 1e-5);
    }
}

#[test]
fn a_long_constant_is_constant() {
    // The plain sum of a million tenths has a relative error of 1e-11.
    let phi = DVector::repeat(1_000_000, 0.1);
    assert!(matches!(potential_nmse(&phi, &phi), Err(MetricsError::ConstantTruth { samples: 1_000_000, .. })));
}
