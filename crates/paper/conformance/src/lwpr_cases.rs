//! LWPR's predictions after training on the same samples in the same order.

use std::path::Path;

use anyhow::ensure;
use lwpr::{Kernel, Lwpr, LwprParams, Metric, MetricAdaptation, Predictor};
use nalgebra::DVector;
use serde::Deserialize;

use super::{Agreement, TOLERANCE, columns, read_json};

/// From this confidence on, the reference has no receptive field in reach.
const NO_SUPPORT: f64 = 1e18;

/// From this value of (samples × (1 − λ)) on, a field accumulates errors.
const ERRORS_FROM: f64 = 0.1;

#[derive(Debug, Deserialize)]
struct Case {
    n_in: usize,
    n_out: usize,
    params: Params,
    passes: usize,
    cutoff: f64,
    x_train: Vec<Vec<f64>>,
    y_train: Vec<Vec<f64>>,
    x_test: Vec<Vec<f64>>,
    n_receptive_fields: Vec<usize>,
    n_pruned: Vec<usize>,
    value: Vec<Vec<f64>>,
    gradient: Vec<Vec<Vec<f64>>>,
    confidence: Vec<Vec<f64>>,
    max_activation: Vec<Vec<f64>>,
}

#[derive(Debug, Deserialize)]
#[allow(non_snake_case, clippy::struct_excessive_bools, reason = "the names and types of the reference files")]
struct Params {
    norm_in: Vec<f64>,
    norm_out: Vec<f64>,
    init_alpha: f64,
    diag_only: bool,
    update_D: bool,
    meta: bool,
    meta_rate: f64,
    penalty: f64,
    w_gen: f64,
    w_prune: f64,
    init_lambda: f64,
    final_lambda: f64,
    tau_lambda: f64,
    add_threshold: f64,
    kernel: String,
    init_D_diagonal: f64,
}

/// Compares values, gradients, activations and confidence.
pub(super) fn check(file: &Path) -> anyhow::Result<Vec<Agreement>> {
    let case: Case = read_json(file)?;
    let mut model = case.params.ours().build(case.n_in, case.n_out)?;
    let (xs, ys) = (columns(&case.x_train), columns(&case.y_train));
    model.fit_in_order(xs.as_view(), ys.as_view(), case.passes)?;
    case.same_counts(&model)?;
    Ok(case.compare(&model.predictor(case.cutoff)))
}

impl Case {
    fn same_counts(&self, model: &Lwpr) -> anyhow::Result<()> {
        for output in 0..self.n_out {
            let (ours, theirs) = (model.n_receptive_fields(output), self.n_receptive_fields[output]);
            ensure!(ours == theirs, "output {output} has {ours} receptive fields, in the reference {theirs}");
            let (ours, theirs) = (model.n_pruned(output), self.n_pruned[output]);
            ensure!(ours == theirs, "output {output} pruned {ours} receptive fields, in the reference {theirs}");
        }
        Ok(())
    }

    /// Whether no field can have accumulated errors yet. Our confidence is then undefined, and the reference's means
    /// little.
    fn is_young(&self) -> bool {
        let samples = self.passes * self.x_train.len();
        samples as f64 * (1.0 - self.params.init_lambda) < ERRORS_FROM
    }

    fn compare(&self, predictor: &Predictor) -> Vec<Agreement> {
        let [mut value, mut gradient, mut confidence, mut activation] = [const { Vec::new() }; 4];
        for (i, x) in columns(&self.x_test).column_iter().enumerate() {
            for output in 0..self.n_out {
                activation.push((predictor.max_activation(x.as_view(), output), self.max_activation[i][output]));
            }
            let Some(prediction) = predictor.predict(x.as_view()) else {
                // The reference signals this by a huge confidence; otherwise the difference is infinite.
                let excused = self.confidence[i].iter().any(|&confidence| confidence > NO_SUPPORT);
                value.push((if excused { 0.0 } else { f64::INFINITY }, 0.0));
                continue;
            };
            for output in 0..self.n_out {
                value.push((prediction.value[output], self.value[i][output]));
                for k in 0..self.n_in {
                    gradient.push((prediction.gradient[(output, k)], self.gradient[i][output][k]));
                }
                let (ours, theirs) = (prediction.confidence[output], self.confidence[i][output]);
                if ours.is_finite() || !self.is_young() {
                    confidence.push((ours, theirs));
                }
            }
        }
        let numbers =
            [("values", value), ("gradients", gradient), ("confidence", confidence), ("activations", activation)];
        let agreement = |(what, pairs): (_, Vec<(f64, f64)>)| {
            let mut agreement = Agreement::new(what, TOLERANCE);
            let (ours, theirs): (Vec<f64>, Vec<f64>) = pairs.into_iter().unzip();
            agreement.compare(ours, &theirs);
            agreement
        };
        numbers.map(agreement).into()
    }
}

impl Params {
    fn ours(&self) -> LwprParams {
        LwprParams {
            init_d: self.init_D_diagonal,
            init_alpha: self.init_alpha,
            metric: if self.diag_only { Metric::Diagonal } else { Metric::Full },
            adaptation: match (self.update_D, self.meta) {
                (false, _) => MetricAdaptation::Fixed,
                (true, false) => MetricAdaptation::Gradient,
                (true, true) => MetricAdaptation::Meta { rate: self.meta_rate },
            },
            kernel: if self.kernel == "bisquare" { Kernel::BiSquare } else { Kernel::Gaussian },
            penalty: self.penalty,
            w_gen: self.w_gen,
            w_prune: self.w_prune,
            init_lambda: self.init_lambda,
            final_lambda: self.final_lambda,
            tau_lambda: self.tau_lambda,
            add_threshold: self.add_threshold,
            norm_in: Some(DVector::from_column_slice(&self.norm_in)),
            norm_out: Some(DVector::from_column_slice(&self.norm_out)),
            ..LwprParams::default()
        }
    }
}
