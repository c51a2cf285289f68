use nalgebra::{DMatrix, DVector, DVectorView, DVectorViewMut};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::contribution::Contribution;
use crate::error::Side;
use crate::field_table::{FieldTable, Query};
use crate::local_model::LocalModel;
use crate::predictor_record::PredictorRecord;
use crate::{Kernel, Lwpr, LwprError};

/// An immutable snapshot of a model that predicts; made by [`Lwpr::predictor`]. Threads may share it.
///
/// A query is (`n_in`) numbers in the units the model was trained with. One that has another length or is not finite has
/// no support; [`predict_batch`](Self::predict_batch) refuses it instead.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "PredictorRecord", into = "PredictorRecord")]
pub struct Predictor {
    kernel: Kernel,
    cutoff: f64,
    reach: f64,
    norm_in: Vec<f64>,
    /// 1 / norm_in: a division costs as much as ten products.
    per_norm_in: Vec<f64>,
    norm_out: Vec<f64>,
    outputs: Vec<OutputFields>,
}

/// The fields of one output.
#[derive(Debug, Clone, PartialEq)]
struct OutputFields {
    models: Vec<LocalModel>,
    /// `None` for full metrics.
    table: Option<FieldTable>,
}

/// What a model says about one input.
#[derive(Debug, Clone, PartialEq)]
pub struct Prediction {
    /// The prediction (`n_out`).
    pub value: DVector<f64>,
    /// Its derivative by the input (`n_out`, `n_in`).
    pub gradient: DMatrix<f64>,
    /// Predictive standard deviation (`n_out`), in the units of the outputs; infinite where no field that takes part
    /// has collected errors yet (in its first hundred samples or so, with the default forgetting).
    pub confidence: DVector<f64>,
    /// Activation of the nearest receptive field (`n_out`), whether it takes part or not.
    pub max_activation: DVector<f64>,
}

impl Predictor {
    pub(crate) fn new(model: &Lwpr, cutoff: f64) -> Self {
        let settings = &model.settings;
        let freeze = |field| LocalModel::new(field, settings);
        Self::from_record(PredictorRecord {
            kernel: settings.params.kernel,
            cutoff: cutoff.max(0.0),
            norm_in: settings.norm_in.clone(),
            norm_out: settings.norm_out.clone(),
            outputs: model.outputs.iter().map(|o| o.fields.iter().filter_map(freeze).collect()).collect(),
        })
    }

    /// From a record that has been checked.
    pub(crate) fn from_record(record: PredictorRecord) -> Self {
        let PredictorRecord { kernel, cutoff, norm_in, norm_out, outputs } = record;
        let n = norm_in.len();
        let fields = |models: Vec<LocalModel>| {
            let diagonal = models.iter().all(|model| model.metric.len() == n);
            OutputFields { table: diagonal.then(|| FieldTable::new(n, &models)), models }
        };
        Predictor {
            kernel,
            cutoff,
            // Where rounding might decide, the activation itself does.
            reach: kernel.reach(cutoff.min(1.0)) + 1e-6,
            per_norm_in: norm_in.iter().map(|norm| 1.0 / norm).collect(),
            norm_in,
            norm_out,
            outputs: outputs.into_iter().map(fields).collect(),
        }
    }

    pub(crate) fn record(&self) -> PredictorRecord {
        PredictorRecord {
            kernel: self.kernel,
            cutoff: self.cutoff,
            norm_in: self.norm_in.clone(),
            norm_out: self.norm_out.clone(),
            outputs: self.outputs.iter().map(|output| output.models.clone()).collect(),
        }
    }

    /// Everything about `x`; `None` if some output has no trustworthy field activated above the cutoff.
    pub fn predict(&self, x: DVectorView<'_, f64>) -> Option<Prediction> {
        let (n_in, n_out) = (self.n_in(), self.n_out());
        let normalised = self.normalised(x)?;
        let mut prediction = Prediction {
            value: DVector::zeros(n_out),
            gradient: DMatrix::zeros(n_out, n_in),
            confidence: DVector::zeros(n_out),
            max_activation: DVector::zeros(n_out),
        };
        let mut gradient = DVector::zeros(n_in);
        for output in 0..n_out {
            prediction.value[output] = self.value_and_gradient_into(x, output, gradient.as_view_mut())?;
            prediction.gradient.row_mut(output).tr_copy_from(&gradient);
            prediction.confidence[output] = self.normalised_confidence(&normalised, output)? * self.norm_out[output];
            prediction.max_activation[output] = self.normalised_activation(&normalised, output);
        }
        Some(prediction)
    }

    /// [`predict`](Self::predict) for every column of `xs` (`n_in`, N), in parallel; the same at any thread count.
    ///
    /// # Errors
    /// [`LwprError::Dimension`] or [`LwprError::BadValue`].
    pub fn predict_batch(&self, xs: &DMatrix<f64>) -> Result<Vec<Option<Prediction>>, LwprError> {
        self.check_queries(xs)?;
        Ok((0..xs.ncols()).into_par_iter().map(|sample| self.predict(xs.column(sample).as_view())).collect())
    }

    /// [`value`](Self::value) for every column of `xs` (`n_in`, N), in parallel; the same at any thread count.
    ///
    /// # Errors
    /// [`LwprError::Dimension`] or [`LwprError::BadValue`].
    ///
    /// # Panics
    /// If there is no such output.
    pub fn values(&self, xs: &DMatrix<f64>, output: usize) -> Result<Vec<Option<f64>>, LwprError> {
        self.check_queries(xs)?;
        Ok((0..xs.ncols()).into_par_iter().map(|sample| self.value(xs.column(sample).as_view(), output)).collect())
    }

    /// Prediction of one output; `None` without support. Allocates nothing with a diagonal metric.
    ///
    /// # Panics
    /// If there is no such output.
    pub fn value(&self, x: DVectorView<'_, f64>, output: usize) -> Option<f64> {
        self.evaluate(x, output, None).map(|value| value * self.norm_out[output])
    }

    /// Prediction of one output and its derivative by the input (`n_in`), written into `gradient`; `None` without
    /// support (`gradient` may then hold anything). Allocates nothing with a diagonal metric.
    ///
    /// # Panics
    /// If there is no such output, or `gradient` has not `n_in` elements.
    pub fn value_and_gradient_into(
        &self,
        x: DVectorView<'_, f64>,
        output: usize,
        mut gradient: DVectorViewMut<'_, f64>,
    ) -> Option<f64> {
        assert_eq!(gradient.len(), self.n_in(), "the gradient has one element for each input");
        let value = self.evaluate(x, output, Some(gradient.as_mut_slice()))?;
        for (gradient, per_norm) in gradient.as_mut_slice().iter_mut().zip(&self.per_norm_in) {
            *gradient *= self.norm_out[output] * per_norm;
        }
        Some(value * self.norm_out[output])
    }

    /// Second derivative of one output by the input (`n_in`, `n_in`); `None` without support.
    ///
    /// # Panics
    /// If there is no such output.
    pub fn hessian(&self, x: DVectorView<'_, f64>, output: usize) -> Option<DMatrix<f64>> {
        let x = self.normalised(x)?;
        let fields = self.contributions(&x, output);
        let sum_w: f64 = fields.iter().map(|field| field.activation.w).sum();
        let value = fields.iter().map(|field| field.activation.w * field.y).sum::<f64>() / sum_w;
        let n = x.len();
        let (mut gradient, mut weight_gradient) = (DVector::zeros(n), DVector::zeros(n));
        let mut hessian = DMatrix::zeros(n, n);
        for field in &fields {
            let (slope, dw) = (field.slope(), 2.0 * field.activation.slope * &field.v);
            gradient += field.activation.w * &slope + (field.y - value) * &dw;
            hessian +=
                (field.y - value) * field.activation_hessian() + &dw * slope.transpose() + slope * dw.transpose();
            weight_gradient += dw;
        }
        gradient /= sum_w;
        hessian -= &gradient * weight_gradient.transpose() + &weight_gradient * gradient.transpose();
        let scale = |i: usize, j: usize| self.norm_out[output] / (sum_w * self.norm_in[i] * self.norm_in[j]);
        (sum_w > 0.0).then(|| DMatrix::from_fn(n, n, |i, j| hessian[(i, j)] * scale(i, j)))
    }

    /// Predictive standard deviation of one output, in its units; `None` without support, infinite where no field that
    /// takes part has collected errors yet.
    ///
    /// # Panics
    /// If there is no such output.
    pub fn confidence(&self, x: DVectorView<'_, f64>, output: usize) -> Option<f64> {
        Some(self.normalised_confidence(&self.normalised(x)?, output)? * self.norm_out[output])
    }

    /// Activation of the nearest receptive field, trustworthy or not: how far `x` is from everything learnt. 0 for a
    /// query that is not finite or has another length.
    ///
    /// # Panics
    /// If there is no such output.
    pub fn max_activation(&self, x: DVectorView<'_, f64>, output: usize) -> f64 {
        self.normalised(x).map_or(0.0, |x| self.normalised_activation(&x, output))
    }

    /// Number of inputs.
    pub fn n_in(&self) -> usize {
        self.norm_in.len()
    }

    /// Number of outputs.
    pub fn n_out(&self) -> usize {
        self.norm_out.len()
    }

    fn check_queries(&self, xs: &DMatrix<f64>) -> Result<(), LwprError> {
        if xs.nrows() != self.n_in() {
            return Err(LwprError::Dimension { side: Side::Input, found: xs.nrows(), expected: self.n_in() });
        }
        match xs.iter().position(|x| !x.is_finite()) {
            None => Ok(()),
            Some(at) => Err(LwprError::BadValue {
                side: Side::Input,
                sample: at / xs.nrows(),
                dimension: at % xs.nrows(),
                value: xs[at],
            }),
        }
    }

    fn is_query(&self, x: DVectorView<'_, f64>) -> bool {
        x.len() == self.n_in() && x.iter().all(|x| x.is_finite())
    }

    fn normalised(&self, x: DVectorView<'_, f64>) -> Option<DVector<f64>> {
        self.is_query(x).then(|| DVector::from_iterator(x.len(), x.iter().zip(&self.norm_in).map(|(x, norm)| x / norm)))
    }

    fn contributions(&self, x: &DVector<f64>, output: usize) -> Vec<Contribution<'_>> {
        let models = self.outputs[output].models.iter();
        models.filter_map(|model| Contribution::new(model, self.kernel, self.cutoff, x)).collect()
    }

    /// Normalised prediction and gradient.
    fn evaluate(&self, x: DVectorView<'_, f64>, output: usize, gradient: Option<&mut [f64]>) -> Option<f64> {
        let fields = &self.outputs[output];
        if !self.is_query(x) {
            return None;
        }
        if let Some(table) = &fields.table {
            let Predictor { kernel, cutoff, reach, ref per_norm_in, .. } = *self;
            return table.predict(Query { kernel, cutoff, reach, x: x.as_slice(), per_norm_in }, gradient);
        }
        let fields = self.contributions(&self.normalised(x)?, output);
        let sum_w: f64 = fields.iter().map(|field| field.activation.w).sum();
        let value = fields.iter().map(|field| field.activation.w * field.y).sum::<f64>() / sum_w;
        for (i, gradient) in gradient.into_iter().flatten().enumerate() {
            let term = |field: &Contribution<'_>| {
                field.activation.w * field.affine.slope[i]
                    + 2.0 * field.activation.slope * (field.y - value) * field.v[i]
            };
            *gradient = fields.iter().map(term).sum::<f64>() / sum_w;
        }
        (sum_w > 0.0).then_some(value)
    }

    /// √|Σ w σ² + Σ w y² − (Σ w y)²/Σ w| / Σ w. Fields without errors add their spread, but no noise of their own.
    fn normalised_confidence(&self, x: &DVector<f64>, output: usize) -> Option<f64> {
        let (mut sum_w, mut sum_wy, mut sum_wyy, mut noise) = (0.0, 0.0, 0.0, None::<f64>);
        for field in self.contributions(x, output) {
            let w = field.activation.w;
            sum_w += w;
            sum_wy += w * field.y;
            sum_wyy += w * field.y * field.y;
            if let Some(variance) = field.variance(x) {
                noise = Some(noise.unwrap_or(0.0) + w * variance);
            }
        }
        let spread = |noise: f64| (noise + sum_wyy - sum_wy * sum_wy / sum_w).abs().sqrt() / sum_w;
        (sum_w > 0.0).then(|| noise.map_or(f64::INFINITY, spread))
    }

    fn normalised_activation(&self, x: &DVector<f64>, output: usize) -> f64 {
        self.outputs[output].models.iter().map(|model| model.activation(self.kernel, x)).fold(0.0, f64::max)
    }
}
