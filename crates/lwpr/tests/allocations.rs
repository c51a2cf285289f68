//! Prediction does not allocate, except for returned results.

#![allow(clippy::unwrap_used)] // A panic is how a test fails.

use lwpr::{Lwpr, LwprParams, Metric, Prediction};
use nalgebra::{DMatrix, DVector};

/// Number of allocations of this thread in `work`.
fn allocations(work: impl FnOnce()) -> u64 {
    allocation_counter::measure(work).count_total
}

/// Two outputs, fields with and without support, and query points.
fn trained(n_in: usize, metric: Metric) -> (Lwpr, DMatrix<f64>) {
    let params = LwprParams { metric, init_d: 20.0 / n_in as f64, w_prune: 0.9, ..LwprParams::default() };
    let mut model = params.build(n_in, 2).unwrap();
    let xs = DMatrix::from_fn(n_in, 500, |i, j| ((j * (i + 3)) as f64 * 0.37).sin());
    let ys = DMatrix::from_fn(2, 500, |i, j| (xs[(0, j)] * (i + 1) as f64).sin());
    model.fit_in_order(xs.as_view(), ys.as_view(), 2).unwrap();
    (model, xs)
}

#[test]
fn predictions_allocate_nothing_but_their_answers() {
    for (n_in, metric) in
        [(1, Metric::Diagonal), (2, Metric::Diagonal), (2, Metric::Full), (6, Metric::Full), (22, Metric::Diagonal)]
    {
        let (model, xs) = trained(n_in, metric);
        let predictor = model.predictor(0.001);
        let mut prediction = Prediction::zeros(n_in, 2);
        let (mut gradient, mut supported) = (DVector::zeros(n_in), 0);
        // The first query allocates scratch memory.
        let mut all = |supported: &mut usize| {
            for x in xs.column_iter() {
                *supported += usize::from(predictor.predict_into(x, &mut prediction));
                predictor.value(x, 1);
                predictor.value_and_gradient_into(x, 0, gradient.as_view_mut());
                predictor.confidence(x, 1);
                predictor.max_activation(x, 0);
                *supported += usize::from(model.predict_into(x, 0.001, &mut prediction));
                model.value_and_gradient_into(x, 1, 0.001, gradient.as_view_mut());
            }
        };
        all(&mut supported);
        assert_eq!(allocations(|| all(&mut supported)), 0, "{n_in} {metric:?}");
        assert!(supported > 500, "{n_in} {metric:?}: {supported}");

        let x = xs.column(7);
        assert!(predictor.predict(x).is_some());
        // Value, gradient, confidence and activation.
        assert_eq!(allocations(|| drop(predictor.predict(x))), 4);
        predictor.hessian(x, 0);
        assert_eq!(allocations(|| drop(predictor.hessian(x, 0))), 1);
    }
}

#[test]
fn an_update_allocates_nothing_either() {
    for (n_in, metric) in [(2, Metric::Diagonal), (2, Metric::Full), (22, Metric::Diagonal)] {
        let (mut model, xs) = trained(n_in, metric);
        let ys = DMatrix::from_fn(2, 500, |i, j| (xs[(0, j)] * (i + 1) as f64).sin());
        let shape = |model: &Lwpr| -> Vec<usize> {
            (0..2).flat_map(|output| model.receptive_fields(output).map(|field| field.n_projections())).collect()
        };
        let (mut born_or_grown, mut allocated) = (0, 0);
        for (x, y) in xs.column_iter().zip(ys.column_iter()) {
            let before = shape(&model);
            let count = allocations(|| model.update(x, y).unwrap());
            if before == shape(&model) {
                allocated += count;
            } else {
                born_or_grown += 1;
            }
        }
        assert_eq!(allocated, 0, "{n_in} {metric:?}");
        assert!(born_or_grown < 100, "{n_in} {metric:?}: {born_or_grown}");
    }
}
