//! Invalid input and the resulting errors.

use lwpr::{Lwpr, LwprError, LwprParams, Metric, MetricAdaptation, Side};
use nalgebra::{DMatrix, DVector, dmatrix, dvector};

fn params() -> LwprParams {
    LwprParams::default()
}

fn refused(params: LwprParams) -> LwprError {
    params.build(2, 1).unwrap_err()
}

#[test]
fn parameters_out_of_range() {
    let cases: Vec<(&str, f64, LwprParams)> = vec![
        ("init_d", 0.0, LwprParams { init_d: 0.0, ..params() }),
        ("init_d", f64::INFINITY, LwprParams { init_d: f64::INFINITY, ..params() }),
        ("init_alpha", -1.0, LwprParams { init_alpha: -1.0, ..params() }),
        ("adaptation.rate", -2.0, LwprParams { adaptation: MetricAdaptation::Meta { rate: -2.0 }, ..params() }),
        ("penalty", -1e-6, LwprParams { penalty: -1e-6, ..params() }),
        ("w_gen", 0.0, LwprParams { w_gen: 0.0, ..params() }),
        ("w_gen", 1.0, LwprParams { w_gen: 1.0, ..params() }),
        ("w_prune", 0.0, LwprParams { w_prune: 0.0, ..params() }),
        ("w_prune", 1.5, LwprParams { w_prune: 1.5, ..params() }),
        ("init_lambda", 0.0, LwprParams { init_lambda: 0.0, ..params() }),
        ("final_lambda", 1.1, LwprParams { final_lambda: 1.1, ..params() }),
        ("init_lambda", 0.4999, LwprParams { init_lambda: 0.4999, ..params() }),
        ("final_lambda", 0.0, LwprParams { final_lambda: 0.0, ..params() }),
        ("tau_lambda", -0.1, LwprParams { tau_lambda: -0.1, ..params() }),
        ("add_threshold", -0.5, LwprParams { add_threshold: -0.5, ..params() }),
        ("init_s2", 0.0, LwprParams { init_s2: 0.0, ..params() }),
        ("max_receptive_fields", 0.0, LwprParams { max_receptive_fields: Some(0), ..params() }),
    ];
    for (name, value, params) in cases {
        match refused(params) {
            LwprError::Parameter { name: found, value: of, .. } => assert_eq!((found, of), (name, value)),
            other => panic!("{name}: {other}"),
        }
    }
    assert!(matches!(refused(LwprParams { w_gen: f64::NAN, ..params() }), LwprError::Parameter { name: "w_gen", .. }));
    assert_eq!(params().build(0, 1).unwrap_err(), LwprError::NoDimension { n_in: 0, n_out: 1 });
    assert_eq!(params().build(2, 0).unwrap_err(), LwprError::NoDimension { n_in: 2, n_out: 0 });
    let too_many = |side, found, most| LwprError::TooManyDimensions { side, found, most };
    let full = LwprParams { metric: Metric::Full, ..params() };
    assert_eq!(params().build(1 << 40, 1).unwrap_err(), too_many(Side::Input, 1 << 40, 1 << 16));
    assert_eq!(params().build(1, usize::MAX).unwrap_err(), too_many(Side::Output, usize::MAX, 1 << 16));
    assert_eq!(full.build(40_000, 1).unwrap_err(), too_many(Side::Input, 40_000, 1 << 10));
}

#[test]
fn metrics() {
    let with = |metric: DMatrix<f64>, shape| LwprParams { init_metric: Some(metric), metric: shape, ..params() };
    let full = |metric| refused(with(metric, Metric::Full));
    assert_eq!(full(DMatrix::identity(3, 3)), LwprError::MetricShape { shape: (3, 3), n_in: 2 });
    assert_eq!(full(dmatrix![2.0, 1.0; 0.5, 2.0]), LwprError::MetricAsymmetric { row: 0, column: 1 });
    assert_eq!(full(dmatrix![1.0, 2.0; 2.0, 1.0]), LwprError::MetricNotPositiveDefinite);
    assert_eq!(full(dmatrix![1.0, 0.0; 0.0, 0.0]), LwprError::MetricNotPositiveDefinite);
    assert_eq!(full(dmatrix![f64::NAN, 0.0; 0.0, 1.0]), LwprError::MetricNotPositiveDefinite);
    assert_eq!(
        refused(with(dmatrix![2.0, 0.5; 0.5, 2.0], Metric::Diagonal)),
        LwprError::MetricNotDiagonal { row: 0, column: 1, value: 0.5 }
    );
    let model = with(dmatrix![2.0, 0.5; 0.5, 3.0], Metric::Full).build(2, 1).unwrap();
    assert_eq!(model.n_receptive_fields(0), 0);
}

#[test]
fn norms() {
    let short = LwprParams { norm_in: Some(dvector![1.0]), ..params() };
    assert_eq!(refused(short), LwprError::NormLength { side: Side::Input, found: 1, expected: 2 });
    let zero = LwprParams { norm_in: Some(dvector![1.0, 0.0]), ..params() };
    assert_eq!(refused(zero), LwprError::Norm { side: Side::Input, dimension: 1, value: 0.0 });
    let negative = LwprParams { norm_out: Some(dvector![-1.0]), ..params() };
    assert_eq!(refused(negative), LwprError::Norm { side: Side::Output, dimension: 0, value: -1.0 });
}

/// A model with a few fields.
fn trained() -> Lwpr {
    let mut model = params().build(2, 1).unwrap();
    let xs = DMatrix::from_fn(2, 200, |i, j| ((j * (i + 3)) as f64 * 0.37).sin());
    let ys = DMatrix::from_fn(1, 200, |_, j| xs[(0, j)]);
    model.fit_in_order(xs.as_view(), ys.as_view(), 2).unwrap();
    model
}

#[test]
fn samples() {
    let mut model = trained();
    let before = serde_json::to_string(&model).unwrap();
    let (x, y) = (dvector![0.1, 0.2], dvector![0.3]);
    let mut update = |x: &DVector<f64>, y: &DVector<f64>| model.update(x.as_view(), y.as_view()).unwrap_err();
    let dimension = |side, found, expected| LwprError::Dimension { side, found, expected };
    assert_eq!(update(&dvector![0.1], &y), dimension(Side::Input, 1, 2));
    assert_eq!(update(&x, &dvector![]), dimension(Side::Output, 0, 1));
    for value in [f64::INFINITY, f64::NEG_INFINITY, 1e60, -1e300] {
        let bad = |side, dimension| LwprError::BadValue { side, sample: 0, dimension, value };
        assert_eq!(update(&dvector![0.1, value], &y), bad(Side::Input, 1));
        assert_eq!(update(&x, &dvector![value]), bad(Side::Output, 0));
    }
    let nan = update(&dvector![f64::NAN, 0.0], &y);
    assert!(matches!(nan, LwprError::BadValue { side: Side::Input, dimension: 0, .. }), "{nan}");

    let mut xs = DMatrix::zeros(2, 5);
    let ys = DMatrix::zeros(1, 5);
    let mut fit = |xs: &DMatrix<f64>, ys: &DMatrix<f64>| model.fit_in_order(xs.as_view(), ys.as_view(), 1).unwrap_err();
    assert_eq!(fit(&DMatrix::zeros(2, 0), &DMatrix::zeros(1, 0)), LwprError::EmptyBatch);
    assert_eq!(fit(&xs, &DMatrix::zeros(1, 4)), LwprError::SampleCount { inputs: 5, outputs: 4 });
    assert_eq!(fit(&DMatrix::zeros(3, 5), &ys), dimension(Side::Input, 3, 2));
    xs[(1, 3)] = f64::INFINITY;
    let bad = LwprError::BadValue { side: Side::Input, sample: 3, dimension: 1, value: f64::INFINITY };
    assert_eq!(fit(&xs, &ys), bad);
    assert_eq!(model.predictor(0.001).predict_batch(xs.as_view()).unwrap_err(), bad);
    assert_eq!(
        model.predictor(0.001).values(DMatrix::zeros(1, 1).as_view(), 0).unwrap_err(),
        dimension(Side::Input, 1, 2)
    );
    assert_eq!(serde_json::to_string(&model).unwrap(), before);
}

#[test]
fn queries_without_support() {
    let predictor = trained().predictor(0.001);
    assert!(predictor.predict(dvector![0.1, 0.2].as_view()).is_some());
    for x in [
        dvector![0.1],
        dvector![f64::NAN, 0.0],
        dvector![f64::INFINITY, 0.0],
        dvector![1e200, 0.0],
        dvector![50.0, 50.0],
    ] {
        assert!(predictor.predict(x.as_view()).is_none(), "{x}");
        assert!(predictor.value(x.as_view(), 0).is_none() && predictor.hessian(x.as_view(), 0).is_none(), "{x}");
        assert!(predictor.confidence(x.as_view(), 0).is_none(), "{x}");
        assert!(predictor.max_activation(x.as_view(), 0) < 0.001, "{x}");
    }
    let empty = params().build(2, 1).unwrap().predictor(0.0);
    assert!(empty.predict(dvector![0.0, 0.0].as_view()).is_none());
}

#[test]
fn too_many_fields() {
    let limited = LwprParams { max_receptive_fields: Some(3), ..params() };
    let xs = DMatrix::from_fn(2, 6, |i, j| if i == 0 { j as f64 } else { 0.0 });
    let ys = DMatrix::zeros(1, 6);
    let refused = LwprError::TooManyReceptiveFields { sample: 3, output: 0, limit: 3 };
    let mut model = limited.clone().build(2, 1).unwrap();
    assert_eq!(model.fit_in_order(xs.as_view(), ys.as_view(), 1).unwrap_err(), refused);
    assert_eq!((model.n_data(), model.n_receptive_fields(0)), (0, 0));
    for i in 0..3 {
        model.update(xs.column(i).as_view(), ys.column(i).as_view()).unwrap();
    }
    let error = model.update(xs.column(3).as_view(), ys.column(3).as_view()).unwrap_err();
    assert_eq!(error, LwprError::TooManyReceptiveFields { sample: 0, output: 0, limit: 3 });
    assert_eq!((model.n_data(), model.n_receptive_fields(0)), (3, 3));
}
