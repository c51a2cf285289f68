//! Stored models and predictors: invalid ones are refused, and every trained model can be read again.

use crate::support::case;
use lwpr::{Kernel, Lwpr, LwprParams, Metric, MetricAdaptation, Predictor};
use nalgebra::DMatrix;
use proptest::prelude::*;
use serde_json::{Value, json};

/// A model with a few fields.
fn trained(metric: Metric) -> Lwpr {
    let mut model = LwprParams { metric, ..LwprParams::default() }.build(2, 1).unwrap();
    let xs = DMatrix::from_fn(2, 200, |i, j| ((j * (i + 3)) as f64 * 0.37).sin());
    let ys = DMatrix::from_fn(1, 200, |_, j| xs[(0, j)]);
    model.fit_in_order(xs.as_view(), ys.as_view(), 2).unwrap();
    model
}

/// `good` with one value replaced.
fn spoilt(good: &Value, path: &str, value: Value) -> Value {
    let mut bad = good.clone();
    *bad.pointer_mut(path).unwrap_or_else(|| panic!("there is no {path}")) = value;
    bad
}

#[test]
fn a_metric_has_as_many_numbers_as_its_shape_says() {
    for shape in ["[],4294967296,4294967296", "[],9223372036854775807,2", "[1,2,3],2,2", "[1],0,1"] {
        let text = format!(r#"{{"init_metric":[{shape}]}}"#);
        let error = serde_json::from_str::<LwprParams>(&text).unwrap_err();
        assert!(error.to_string().contains("a matrix of shape"), "{text}: {error}");
    }
    let params =
        LwprParams { init_metric: Some(DMatrix::from_vec(2, 2, vec![2.0, 0.5, 0.5, 3.0])), ..LwprParams::default() };
    assert_eq!(serde_json::from_str::<LwprParams>(&serde_json::to_string(&params).unwrap()).unwrap(), params);
    assert_eq!(serde_json::from_str::<LwprParams>(r#"{"init_metric":null}"#).unwrap().init_metric, None);
}

#[test]
fn invalid_models_are_refused() {
    let good = serde_json::to_value(trained(Metric::Diagonal)).unwrap();
    assert!(serde_json::from_value::<Lwpr>(good.clone()).is_ok());
    let spoil: [(&str, Value); 14] = [
        ("/n_in", 3.into()),
        ("/n_in", 1_000_000_000_000_u64.into()),
        ("/n_in", u64::MAX.into()),
        ("/n_out", 2.into()),
        ("/n_out", 1_000_000_000_000_u64.into()),
        ("/n_out", u64::MAX.into()),
        ("/n_data", u64::MAX.into()),
        ("/n_data", (-1).into()),
        ("/params/w_gen", 2.0.into()),
        ("/params/init_lambda", 1e-10.into()),
        ("/params/init_metric", json!([[], 4294967296_u64, 4294967296_u64])),
        ("/outputs/0/n_pruned", u64::MAX.into()),
        ("/outputs/0/fields/0/centre", json!([0.0])),
        ("/outputs/0/fields/0/directions/0/ss2", 0.0.into()),
    ];
    for (path, value) in spoil {
        assert!(serde_json::from_value::<Lwpr>(spoilt(&good, path, value.clone())).is_err(), "{path} {value}");
    }
    // Without a field nothing else determines the number of inputs.
    let empty = spoilt(&good, "/outputs/0/fields", json!([]));
    assert!(serde_json::from_value::<Lwpr>(spoilt(&empty, "/n_in", 1_000_000_000_000_u64.into())).is_err());
    let full = spoilt(&empty, "/params/metric", "Full".into());
    assert!(serde_json::from_value::<Lwpr>(spoilt(&full, "/n_in", 40_000.into())).is_err());
}

#[test]
fn invalid_predictors_are_refused() {
    for metric in [Metric::Diagonal, Metric::Full] {
        let good = serde_json::to_value(trained(metric).predictor(0.001)).unwrap();
        assert!(serde_json::from_value::<Predictor>(good.clone()).is_ok());
        let spoil: [(&str, Value); 8] = [
            ("/cutoff", (-0.1).into()),
            ("/norm_out", json!([1.0, 1.0])),
            ("/outputs/0/0/centre", json!([0.0, 0.0, 0.0])),
            ("/outputs/0/0/centre/0", 1e60.into()),
            ("/outputs/0/0/metric/0", (-25.0).into()),
            ("/outputs/0/0/metric/0", 1e300.into()),
            ("/outputs/0/0/affine/noise", (-1.0).into()),
            ("/outputs/0/0/affine/slope/0", 1e300.into()),
        ];
        for (path, value) in spoil {
            let bad = spoilt(&good, path, value.clone());
            assert!(serde_json::from_value::<Predictor>(bad).is_err(), "{metric:?} {path} {value}");
        }
        let other = if metric == Metric::Full { json!([1.0, 1.0]) } else { json!([1.0, 0.0, 0.0, 1.0]) };
        assert!(serde_json::from_value::<Predictor>(spoilt(&good, "/outputs/0/0/metric", other)).is_err());
        if metric == Metric::Full {
            for d in [json!([1.0, 0.5, -0.5, 1.0]), json!([1.0, 2.0, 2.0, 1.0])] {
                let bad = spoilt(&good, "/outputs/0/0/metric", d.clone());
                assert!(serde_json::from_value::<Predictor>(bad).is_err(), "{d}");
            }
        }
    }
}

/// Reads a stored model, and stores it again.
fn read_back(model: &Lwpr) -> Result<(), String> {
    let text = serde_json::to_string(model).unwrap();
    let again: Lwpr = serde_json::from_str(&text).map_err(|error| error.to_string())?;
    assert_eq!(serde_json::to_string(&again).unwrap(), text);
    let predictor = serde_json::to_string(&model.predictor(0.001)).unwrap();
    serde_json::from_str::<Predictor>(&predictor).map(|_| ()).map_err(|error| error.to_string())
}

#[test]
fn equal_samples_train_a_model_that_reads_back() {
    let params = LwprParams {
        init_lambda: 0.5,
        final_lambda: 0.5,
        metric: Metric::Full,
        kernel: Kernel::BiSquare,
        ..LwprParams::default()
    };
    let mut model = params.build(17, 2).unwrap();
    let (xs, ys) = (DMatrix::repeat(17, 2000, 0.3), DMatrix::repeat(2, 2000, 1.5));
    model.fit_in_order(xs.as_view(), ys.as_view(), 1).unwrap();
    assert_eq!((read_back(&model), model.n_receptive_fields(0)), (Ok(()), 1));

    // Trains until nothing is left of the initial spread of a projection.
    let params = LwprParams { init_lambda: 0.99, final_lambda: 0.99, ..LwprParams::default() };
    let mut model = params.build(2, 1).unwrap();
    let (xs, ys) = (DMatrix::repeat(2, 80_000, 0.3), DMatrix::repeat(1, 80_000, 1.5));
    model.fit_in_order(xs.as_view(), ys.as_view(), 1).unwrap();
    assert_eq!((read_back(&model), model.n_receptive_fields(0)), (Ok(()), 1));
    assert!((model.predictor(0.001).value(xs.column(0), 0).unwrap() - 1.5).abs() < 1e-9);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    #[test]
    fn parameters_at_their_extremes_train_a_model_that_reads_back(
        case in case(150), equal in any::<bool>(),
        (lambda, last, alpha, rate) in (0.5..=1.0, 0.5..=1.0, -10.0..300.0, -10.0..300.0),
        (penalty, s2, threshold) in (-300.0..300.0, -300.0..300.0, -10.0..10.0),
    ) {
        let mut case = case;
        if equal {
            case.xs.fill(0.3);
        }
        let ten = |exponent: f64| 10_f64.powf(exponent);
        case.params.init_lambda = lambda;
        case.params.final_lambda = last;
        case.params.init_alpha = ten(alpha);
        case.params.penalty = ten(penalty);
        case.params.init_s2 = ten(s2);
        case.params.add_threshold = ten(threshold);
        if let MetricAdaptation::Meta { .. } = case.params.adaptation {
            case.params.adaptation = MetricAdaptation::Meta { rate: ten(rate) };
        }
        prop_assert_eq!(read_back(&case.trained(2)), Ok(()));
    }
}
