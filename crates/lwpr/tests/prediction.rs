//! Compares the single sweep over all fields with the literal formulas, and the live model with its snapshot.

use crate::support::case;
use lwpr::{Kernel, Prediction, Predictor};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;
use serde_json::Value;

fn vector(value: &Value) -> DVector<f64> {
    let numbers: Vec<f64> = value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect();
    DVector::from_vec(numbers)
}

/// A stored field and its outputs at a normalised input.
struct Said {
    w: f64,
    dw: f64,
    d2w: f64,
    y: f64,
    slope: DVector<f64>,
    v: DVector<f64>,
    d: DMatrix<f64>,
    variance: Option<f64>,
}

/// w, w′ and w″ at q.
fn activation(kernel: Kernel, q: f64) -> (f64, f64, f64) {
    match kernel {
        Kernel::Gaussian => ((-q / 2.0).exp(), -(-q / 2.0).exp() / 2.0, (-q / 2.0).exp() / 4.0),
        Kernel::BiSquare if q < 4.0 => ((1.0 - q / 4.0).powi(2), -(1.0 - q / 4.0) / 2.0, 1.0 / 8.0),
        Kernel::BiSquare => (0.0, 0.0, 0.0),
    }
}

/// The largest activation, and the outputs of the fields that take part.
fn ask(fields: &Value, kernel: Kernel, cutoff: f64, x: &DVector<f64>) -> (f64, Vec<Said>) {
    let n = x.len();
    let (mut largest, mut said) = (0.0_f64, Vec::new());
    for field in fields.as_array().unwrap() {
        let (centre, metric) = (vector(&field["centre"]), vector(&field["metric"]));
        let d = if metric.len() == n {
            DMatrix::from_diagonal(&metric)
        } else {
            DMatrix::from_vec(n, n, metric.as_slice().to_vec())
        };
        let dx = x - &centre;
        let v = &d * &dx;
        let (w, dw, d2w) = activation(kernel, dx.dot(&v).max(0.0));
        largest = largest.max(w);
        let affine = &field["affine"];
        if affine.is_null() || w <= cutoff {
            continue;
        }
        let slope = vector(&affine["slope"]);
        let y = affine["offset"].as_f64().unwrap() + slope.dot(&dx);
        let loadings = vector(&affine["loadings"]);
        let z = x - vector(&affine["mean"]);
        let squares: f64 = loadings.as_slice().chunks(n).map(|a| DVector::from_column_slice(a).dot(&z).powi(2)).sum();
        let variance = affine["noise"].as_f64().map(|noise| noise * (1.0 + w * squares));
        said.push(Said { w, dw, d2w, y, slope, v, d, variance });
    }
    (largest, said)
}

fn close(ours: f64, theirs: f64, scale: f64) -> bool {
    ours == theirs || (ours - theirs).abs() <= 1e-9 * (scale + theirs.abs())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn predictions_match_the_literal_formulas(
        case in case(200), exponent in -9.0..-1.0, output in 0_usize..3, at in 0_usize..200, away in 0.0..1.0,
    ) {
        let (n, output) = (case.n_in, output % case.n_out);
        // Skips cases in which a field's activation equals the cutoff up to rounding.
        let cutoff = 10_f64.powf(exponent);
        let predictor = case.trained(2).predictor(cutoff);
        let stored = serde_json::to_value(&predictor).unwrap();
        let norm = vector(&stored["norm_in"]);
        let norm_out = stored["norm_out"][output].as_f64().unwrap();
        let x: DVector<f64> = case.xs.column(at) * (1.0 + away);
        let (largest, said) = ask(&stored["outputs"][output], case.params.kernel, cutoff, &x.component_div(&norm));

        prop_assert!(close(predictor.max_activation(x.as_view(), output), largest, 1e-6));
        let mut gradient = DVector::zeros(n);
        let value = predictor.value_and_gradient_into(x.as_view(), output, gradient.as_view_mut());
        prop_assert_eq!(value.is_some(), !said.is_empty());
        let Some(value) = value else { return Ok(()) };
        prop_assert_eq!(predictor.value(x.as_view(), output), Some(value));

        let sum_w: f64 = said.iter().map(|field| field.w).sum();
        let mean = said.iter().map(|field| field.w * field.y).sum::<f64>() / sum_w;
        let scale = said.iter().fold(1.0_f64, |scale, field| scale.max(field.y.abs()).max(field.slope.amax() * field.v.amax()));
        prop_assert!(close(value, mean * norm_out, scale), "{value} {mean}");

        let (mut g, mut a, mut h) = (DVector::zeros(n), DVector::zeros(n), DMatrix::zeros(n, n));
        for Said { w, dw, d2w, y, slope, v, d, .. } in &said {
            g += slope * *w + v * (2.0 * dw * (y - mean));
            a += v * (2.0 * dw);
            h += (v * v.transpose() * (4.0 * d2w) + d * (2.0 * dw)) * (y - mean);
            h += (v * slope.transpose() + slope * v.transpose()) * (2.0 * dw);
        }
        g /= sum_w;
        h = (h - &g * a.transpose() - &a * g.transpose()) / sum_w;
        let hessian = predictor.hessian(x.as_view(), output).unwrap();
        let (g_scale, h_scale) = (scale + g.amax(), scale * scale + h.amax() + g.amax() * a.amax() / sum_w);
        for i in 0..n {
            prop_assert!(close(gradient[i], g[i] * norm_out / norm[i], g_scale), "{gradient} {g}");
            for j in 0..n {
                let expected = h[(i, j)] * norm_out / (norm[i] * norm[j]);
                prop_assert!(close(hessian[(i, j)], expected, h_scale), "{hessian} {h}");
            }
        }
        let confidence = predictor.confidence(x.as_view(), output).unwrap();
        if said.iter().all(|field| field.variance.is_none()) {
            prop_assert_eq!(confidence, f64::INFINITY);
        } else {
            let squares = |field: &Said| field.w * (field.variance.unwrap_or(0.0) + (field.y - mean).powi(2));
            let expected = said.iter().map(squares).sum::<f64>().sqrt() / sum_w * norm_out;
            prop_assert!(close(confidence, expected, 1e-7 * scale), "{confidence} {expected}");
        }
    }

    #[test]
    fn a_model_predicts_as_its_snapshot(case in case(200), exponent in -9.0..-1.0) {
        let cutoff = 10_f64.powf(exponent);
        let model = case.trained(2);
        let predictor = model.predictor(cutoff);
        let (mut ours, mut gradient) = (Prediction::zeros(case.n_in, case.n_out), DVector::zeros(case.n_in));
        let mut theirs = ours.clone();
        for x in case.xs.column_iter() {
            let supported = model.predict_into(x, cutoff, &mut ours);
            prop_assert_eq!(predictor.predict_into(x, &mut theirs), supported);
            prop_assert_eq!(predictor.predict(x), supported.then(|| theirs.clone()));
            let scale = theirs.gradient.amax() + theirs.value.amax();
            for output in 0..case.n_out {
                prop_assert!(close(ours.max_activation[output], theirs.max_activation[output], 1e-6));
                let value = model.value_and_gradient_into(x, output, cutoff, gradient.as_view_mut());
                prop_assert_eq!(value.is_some(), predictor.value(x, output).is_some());
                if value.is_none() {
                    continue;
                }
                prop_assert_eq!((value, gradient.transpose()), (Some(ours.value[output]), ours.gradient.row(output).into_owned()));
                prop_assert!(close(ours.value[output], theirs.value[output], scale));
                prop_assert!(close(ours.confidence[output], theirs.confidence[output], 1e-7 * scale));
                let off = (ours.gradient.row(output) - theirs.gradient.row(output)).amax();
                prop_assert!(off <= 1e-8 * (1.0 + scale), "{} {}", ours.gradient, theirs.gradient);
            }
        }
    }

    #[test]
    fn batch_gradients_equal_single_ones(case in case(100), far in 0_usize..100) {
        let predictor: Predictor = case.trained(1).predictor(0.001);
        let mut xs = case.xs.clone();
        xs.column_mut(far).fill(1e6);
        let mut gradients = DMatrix::zeros(case.n_in, xs.ncols());
        let unsupported = predictor.gradients_into(xs.as_view(), 0, &mut gradients).unwrap();
        let (mut count, mut gradient) = (0, DVector::zeros(case.n_in));
        for (x, column) in xs.column_iter().zip(gradients.column_iter()) {
            if predictor.value_and_gradient_into(x, 0, gradient.as_view_mut()).is_some() {
                prop_assert_eq!(column.into_owned(), gradient.clone());
            } else {
                prop_assert!(column.iter().all(|number| number.is_nan()));
                count += 1;
            }
        }
        prop_assert_eq!(unsupported, count);
        prop_assert!(count > 0);
    }

    /// Small batches stay on one thread; batches large enough for several give the same results.
    #[test]
    fn batch_predictions_equal_single_ones(case in case(100), far in 0_usize..100) {
        let model = case.trained(1);
        let predictor = model.predictor(0.001);
        let mut xs = case.xs.clone();
        xs.column_mut(far).fill(1e6);
        let one_by_one: Vec<_> = xs.column_iter().map(|x| predictor.predict(x)).collect();
        prop_assert!(one_by_one[far].is_none());
        prop_assert_eq!(predictor.predict_batch(xs.as_view()).unwrap(), one_by_one);
        let work = (0..model.n_out()).map(|output| model.n_receptive_fields(output)).sum::<usize>() * case.n_in;
        let many = DMatrix::from_fn(case.n_in, (1 << 18) / work + 1, |i, k| xs[(i, k % 100)]);
        let values = predictor.values(many.as_view(), 0).unwrap();
        let expected: Vec<_> = xs.column_iter().map(|x| predictor.value(x, 0)).collect();
        prop_assert!(values.iter().zip(expected.iter().cycle()).all(|(ours, theirs)| ours == theirs));
    }
}
