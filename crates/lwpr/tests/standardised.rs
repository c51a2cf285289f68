//! Outputs that are centred and divided by their spread.

use crate::support::{Case, case};
use lwpr::{LwprError, LwprParams, Side, StandardisedModel, Training};
use nalgebra::{DMatrix, DVector, dmatrix, dvector};
use proptest::prelude::*;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

fn training(case: &Case) -> Training {
    let params = LwprParams { norm_out: None, ..case.params.clone() };
    Training { params, passes: 2, cutoff: 1e-3 }
}

fn fitted(training: &Training, case: &Case) -> StandardisedModel {
    training.fit(case.xs.as_view(), case.ys.as_view(), &mut ChaCha8Rng::seed_from_u64(case.seed)).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn model_equals_lwpr_of_standardised_outputs(case in case(200)) {
        let model = fitted(&training(&case), &case);
        let n = case.xs.ncols() as f64;
        let mean = case.ys.column_mean();
        let centred = DMatrix::from_fn(case.n_out, case.xs.ncols(), |i, j| case.ys[(i, j)] - mean[i]);
        let spread = DVector::from_fn(case.n_out, |i, _| (centred.row(i).norm_squared() / n).sqrt());
        prop_assert!((model.mean() - &mean).amax() <= 1e-12 * (1.0 + mean.amax()));
        let chosen = model.model().params().norm_out.clone().unwrap();
        prop_assert!((&chosen - &spread).amax() <= 1e-12 * spread.amax(), "{chosen} {spread}");
        prop_assert_eq!(model.model().n_data(), 2 * case.xs.ncols());

        let mut plain = LwprParams { norm_out: Some(chosen), ..case.params.clone() }.build(case.n_in, case.n_out).unwrap();
        let centred = DMatrix::from_fn(case.n_out, case.xs.ncols(), |i, j| case.ys[(i, j)] - model.mean()[i]);
        let rng = &mut ChaCha8Rng::seed_from_u64(case.seed);
        plain.fit_batch(case.xs.as_view(), centred.as_view(), 2, rng).unwrap();
        let plain = plain.predictor(1e-3);
        let (mut ours, mut theirs) = (DVector::zeros(case.n_in), DVector::zeros(case.n_in));
        for x in case.xs.column_iter() {
            for output in 0..case.n_out {
                let value = plain.value_and_gradient_into(x, output, theirs.as_view_mut());
                prop_assert_eq!(model.supports(x, output), value.is_some());
                prop_assert_eq!(model.value(x, output), model.mean()[output] + value.unwrap_or(0.0));
                model.gradient_into(x, output, ours.as_view_mut());
                if value.is_none() {
                    theirs.fill(0.0);
                }
                prop_assert_eq!(&ours, &theirs);
            }
        }
    }

    /// Given divisors are used unchanged; those that would be chosen automatically give the same bits.
    #[test]
    fn outputs_are_divided_by_norms_that_are_given(case in case(150), exponent in -8..8_i32) {
        let given = |norm_out: &DVector<f64>, ys: &DMatrix<f64>| {
            let params = LwprParams { norm_out: Some(norm_out.clone()), ..case.params.clone() };
            let rng = &mut ChaCha8Rng::seed_from_u64(case.seed);
            Training { params, ..training(&case) }.fit(case.xs.as_view(), ys.as_view(), rng).unwrap()
        };
        let chosen = fitted(&training(&case), &case);
        let same = given(chosen.model().params().norm_out.as_ref().unwrap(), &case.ys);
        let (ones, unit) = (DVector::repeat(case.n_out, 1.0), 2.0_f64.powi(exponent));
        let undivided = given(&ones, &case.ys);
        prop_assert_eq!(undivided.model().params().norm_out.as_ref(), Some(&ones));
        let in_units = given(&(&ones * unit), &(&case.ys * unit));
        for x in case.xs.column_iter() {
            for output in 0..case.n_out {
                prop_assert_eq!(chosen.value(x, output).to_bits(), same.value(x, output).to_bits());
                prop_assert_eq!(unit * undivided.value(x, output), in_units.value(x, output));
            }
        }
    }

    #[test]
    fn stored_models_predict_the_same_bits(case in case(150), cutoff in 0.0..0.1) {
        let model = fitted(&training(&case), &case).with_cutoff(cutoff).unwrap();
        let stored: StandardisedModel = serde_json::from_str(&serde_json::to_string(&model).unwrap()).unwrap();
        prop_assert_eq!((stored.cutoff(), stored.mean()), (cutoff, model.mean()));
        for x in case.xs.column_iter() {
            for output in 0..case.n_out {
                prop_assert_eq!(stored.value(x, output).to_bits(), model.value(x, output).to_bits());
            }
        }
    }
}

#[test]
fn equal_outputs_have_spread_one() {
    // In floating point, the mean of 64 times .1 is not .1.
    for output in [7.0, 0.1, -1e30] {
        let (xs, ys) = (DMatrix::from_fn(2, 64, |i, j| (j * (i + 2)) as f64 * 0.1), DMatrix::repeat(1, 64, output));
        let model = Training::default().fit(xs.as_view(), ys.as_view(), &mut ChaCha8Rng::seed_from_u64(1)).unwrap();
        assert_eq!(model.model().params().norm_out, Some(dvector![1.0]));
        assert!((model.value(xs.column(3), 0) / output - 1.0).abs() < 1e-12);
        assert_eq!(model.value(dvector![1e6, 1e6].as_view(), 0), model.mean()[0]);
    }
}

#[test]
fn a_bad_output_is_named_where_it_stands() {
    let (xs, mut ys) = (DMatrix::from_fn(1, 3, |_, j| j as f64), dmatrix![1.0, 2.0, 3.0]);
    for value in [f64::NAN, f64::INFINITY] {
        ys[(0, 1)] = value;
        let refused =
            Training::default().fit(xs.as_view(), ys.as_view(), &mut ChaCha8Rng::seed_from_u64(1)).map(|_| ());
        assert!(
            matches!(refused, Err(LwprError::BadValue { side: Side::Output, sample: 1, dimension: 0, .. })),
            "{refused:?}"
        );
    }
}

#[test]
fn invalid_training_and_stored_models_are_refused() {
    let (xs, ys) = (DMatrix::from_fn(2, 64, |i, j| (j * (i + 2)) as f64 * 0.1), DMatrix::repeat(1, 64, 7.0));
    let fit = |training: Training| {
        training.fit(xs.as_view(), ys.as_view(), &mut ChaCha8Rng::seed_from_u64(1)).map(|_| ()).unwrap_err()
    };
    let parameter = |name, value, range| LwprError::Parameter { name, value, range };
    assert_eq!(fit(Training { passes: 0, ..Training::default() }), parameter("passes", 0.0, "at least 1"));
    for cutoff in [-0.1, 1.0] {
        let error = parameter("cutoff", cutoff, "at least 0 and less than 1");
        assert_eq!(fit(Training { cutoff, ..Training::default() }), error);
    }
    let params = LwprParams { norm_out: Some(dvector![1.0, 1.0]), ..LwprParams::default() };
    let length = LwprError::NormLength { side: Side::Output, found: 2, expected: 1 };
    assert_eq!(fit(Training { params, ..Training::default() }), length);
    let none = Training::default().fit(xs.columns(0, 0), ys.columns(0, 0), &mut ChaCha8Rng::seed_from_u64(1));
    assert_eq!(none.map(|_| ()).unwrap_err(), LwprError::EmptyBatch);

    let model = Training::default().fit(xs.as_view(), ys.as_view(), &mut ChaCha8Rng::seed_from_u64(1)).unwrap();
    let good = serde_json::to_value(&model).unwrap();
    for (path, value) in [
        ("/version", serde_json::json!(2)),
        ("/cutoff", serde_json::json!(1.0)),
        ("/mean", serde_json::json!([0.0, 0.0])),
    ] {
        let mut bad = good.clone();
        *bad.pointer_mut(path).unwrap() = value;
        assert!(serde_json::from_value::<StandardisedModel>(bad).is_err(), "{path}");
    }
}
