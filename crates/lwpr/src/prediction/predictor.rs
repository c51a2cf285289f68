use nalgebra::{DMatrix, DMatrixView, DVectorView, DVectorViewMut};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::field_table::FieldTable;
use super::local_model::{LocalModel, LocalPrediction};
use super::query::{Query, Scale};
use super::record::PredictorRecord;
use super::sweep::{Wanted, sweep};
use super::threads::worth_a_thread;
use super::{Prediction, is_query};
use crate::error::Side;
use crate::settings::require_finite;
use crate::{Kernel, Lwpr, LwprError};

/// An immutable snapshot of a model that predicts; created by [`Lwpr::predictor`]. Threads may share it.
///
/// A query consists of `n_in` numbers in the units of the training data. A query of another length, or with a number that is
/// not finite, has no support; batch functions refuse it instead. Only returned results are allocated; a thread's first
/// query of a model also allocates its scratch memory.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "PredictorRecord", into = "PredictorRecord")]
pub struct Predictor {
    cutoff: f64,
    scale: Scale,
    norm_in: Vec<f64>,
    norm_out: Vec<f64>,
    outputs: Vec<OutputFields>,
}

/// The fields of one output, in stored form and in the form for evaluation.
#[derive(Debug, Clone, PartialEq)]
struct OutputFields {
    models: Vec<LocalModel>,
    table: FieldTable,
}

impl Lwpr {
    /// An immutable snapshot that predicts. Fields whose activation is at most `cutoff` do not take part: 0.001 is a good
    /// choice, 0 uses every field at any distance.
    pub fn predictor(&self, cutoff: f64) -> Predictor {
        let settings = &self.settings;
        let freeze = |field| LocalModel::new(field, settings);
        Predictor::from_record(PredictorRecord {
            kernel: settings.params.kernel,
            cutoff: cutoff.max(0.0),
            norm_in: settings.norm_in.clone(),
            norm_out: settings.norm_out.clone(),
            outputs: self.outputs.iter().map(|o| o.fields.iter().filter_map(freeze).collect()).collect(),
        })
    }
}

impl TryFrom<PredictorRecord> for Predictor {
    type Error = LwprError;

    fn try_from(record: PredictorRecord) -> Result<Self, LwprError> {
        match record.check() {
            Ok(()) => Ok(Predictor::from_record(record)),
            Err(reason) => Err(LwprError::Corrupt { reason: reason.to_owned() }),
        }
    }
}

impl From<Predictor> for PredictorRecord {
    fn from(predictor: Predictor) -> Self {
        predictor.record()
    }
}

impl Predictor {
    /// From a checked record.
    fn from_record(record: PredictorRecord) -> Self {
        let PredictorRecord { kernel, cutoff, norm_in, norm_out, outputs } = record;
        let fields =
            |models: Vec<LocalModel>| OutputFields { table: FieldTable::new(norm_in.len(), &models, cutoff), models };
        Predictor {
            cutoff,
            scale: Scale {
                kernel,
                // The margin leaves cases near the limit, where rounding matters, to a comparison of the activation itself.
                squared_radius: kernel.squared_radius(cutoff.min(1.0)) + 1e-6,
                per_norm_in: norm_in.iter().map(|norm| 1.0 / norm).collect(),
            },
            outputs: outputs.into_iter().map(fields).collect(),
            norm_in,
            norm_out,
        }
    }

    fn record(&self) -> PredictorRecord {
        PredictorRecord {
            kernel: self.scale.kernel,
            cutoff: self.cutoff,
            norm_in: self.norm_in.clone(),
            norm_out: self.norm_out.clone(),
            outputs: self.outputs.iter().map(|output| output.models.clone()).collect(),
        }
    }

    /// The results of `queries` queries, in parallel if that is faster. For a small batch, distributing work to threads, and
    /// memory that one thread allocates and another frees, cost more than the queries.
    fn each<T: Send>(&self, queries: usize, answer: impl Fn(usize) -> T + Send + Sync) -> Vec<T> {
        let fields: usize = self.outputs.iter().map(|output| output.models.len()).sum();
        let together = worth_a_thread(fields, self.n_in());
        if queries < together {
            return (0..queries).map(answer).collect();
        }
        (0..queries).into_par_iter().with_min_len(together).map(answer).collect()
    }

    /// Value, gradient, confidence and activation at `x`; `None` if some output has no trustworthy field with an activation
    /// above the cutoff.
    pub fn predict(&self, x: DVectorView<'_, f64>) -> Option<Prediction> {
        let mut prediction = Prediction::zeros(self.n_in(), self.n_out());
        self.predict_into(x, &mut prediction).then_some(prediction)
    }

    /// The same, written into `prediction`. Returns whether every output has support; otherwise only `max_activation` is
    /// written.
    ///
    /// # Panics
    /// If `prediction` was made for other numbers of inputs and outputs.
    pub fn predict_into(&self, x: DVectorView<'_, f64>, prediction: &mut Prediction) -> bool {
        prediction.fill_with(self.n_in(), self.n_out(), |output, wanted| self.ask(x, output, wanted))
    }

    /// [`predict`](Self::predict) for every column of `xs` (`n_in`, N), in parallel; the same at any thread count.
    ///
    /// # Errors
    /// [`LwprError::Dimension`] or [`LwprError::BadValue`].
    pub fn predict_batch(&self, xs: DMatrixView<'_, f64>) -> Result<Vec<Option<Prediction>>, LwprError> {
        self.check_queries(xs)?;
        Ok(self.each(xs.ncols(), |sample| self.predict(xs.column(sample))))
    }

    /// [`value`](Self::value) for every column of `xs` (`n_in`, N), in parallel; the same at any thread count.
    ///
    /// # Errors
    /// [`LwprError::Dimension`] or [`LwprError::BadValue`].
    ///
    /// # Panics
    /// If there is no such output.
    pub fn values(&self, xs: DMatrixView<'_, f64>, output: usize) -> Result<Vec<Option<f64>>, LwprError> {
        self.check_queries(xs)?;
        Ok(self.each(xs.ncols(), |sample| self.value(xs.column(sample), output)))
    }

    /// Gradients of one output at each column of `xs` (`n_in`, N), written into the columns of `gradients` (`n_in`, N), in
    /// parallel; the same at any thread count. Columns without support become NaN; returns their number.
    ///
    /// # Errors
    /// [`LwprError::Dimension`] or [`LwprError::BadValue`].
    ///
    /// # Panics
    /// If there is no such output, or `gradients` has another shape than `xs`.
    pub fn gradients_into(
        &self,
        xs: DMatrixView<'_, f64>,
        output: usize,
        gradients: &mut DMatrix<f64>,
    ) -> Result<usize, LwprError> {
        assert_eq!(xs.shape(), gradients.shape(), "there is one gradient for each query");
        self.check_queries(xs)?;
        let together = worth_a_thread(self.outputs[output].models.len(), self.n_in());
        let unsupported = |(part, gradients): (usize, &mut [f64])| -> usize {
            let each = gradients.chunks_exact_mut(self.n_in()).enumerate();
            each.map(|(k, gradient)| {
                let wanted = Wanted { gradient: Some((&mut *gradient, 1)), ..Wanted::default() };
                if self.ask_checked(xs.column(part * together + k), output, wanted).is_some() {
                    return 0;
                }
                gradient.fill(f64::NAN);
                1
            })
            .sum()
        };
        let gradients = gradients.as_mut_slice();
        if xs.ncols() <= together {
            return Ok(unsupported((0, gradients)));
        }
        Ok(gradients.par_chunks_mut(together * self.n_in()).enumerate().map(unsupported).sum())
    }

    /// Prediction of one output; `None` without support.
    ///
    /// # Panics
    /// If there is no such output.
    pub fn value(&self, x: DVectorView<'_, f64>, output: usize) -> Option<f64> {
        self.ask(x, output, Wanted::default())
    }

    /// Prediction of one output and its derivative with respect to the input (`n_in`), written into `gradient`; `None`
    /// without support (`gradient` then has arbitrary contents).
    ///
    /// # Panics
    /// If there is no such output, or `gradient` does not have `n_in` elements.
    pub fn value_and_gradient_into(
        &self,
        x: DVectorView<'_, f64>,
        output: usize,
        mut gradient: DVectorViewMut<'_, f64>,
    ) -> Option<f64> {
        assert_eq!(gradient.len(), self.n_in(), "the gradient has one element for each input");
        self.ask(x, output, Wanted { gradient: Some((gradient.as_mut_slice(), 1)), ..Wanted::default() })
    }

    /// Second derivative of one output with respect to the input (`n_in`, `n_in`); `None` without support.
    ///
    /// # Panics
    /// If there is no such output.
    pub fn hessian(&self, x: DVectorView<'_, f64>, output: usize) -> Option<DMatrix<f64>> {
        let mut hessian = DMatrix::zeros(self.n_in(), self.n_in());
        let wanted = Wanted { hessian: Some(hessian.as_mut_slice()), ..Wanted::default() };
        self.ask(x, output, wanted).map(|_| hessian)
    }

    /// Predictive standard deviation of one output, in its units; `None` without support, infinite if no field that takes
    /// part has collected errors yet.
    ///
    /// # Panics
    /// If there is no such output.
    pub fn confidence(&self, x: DVectorView<'_, f64>, output: usize) -> Option<f64> {
        let mut confidence = 0.0;
        self.ask(x, output, Wanted { confidence: Some(&mut confidence), ..Wanted::default() }).map(|_| confidence)
    }

    /// Activation of the nearest receptive field, trustworthy or not: a measure of the distance of `x` from the training
    /// data. 0 for a query that is not finite or has another length.
    ///
    /// # Panics
    /// If there is no such output.
    pub fn max_activation(&self, x: DVectorView<'_, f64>, output: usize) -> f64 {
        let mut max_activation = 0.0;
        self.ask(x, output, Wanted { max_activation: Some(&mut max_activation), ..Wanted::default() });
        max_activation
    }

    /// Decay of activations with distance.
    pub fn kernel(&self) -> Kernel {
        self.scale.kernel
    }

    /// The activation above which receptive fields take part.
    pub fn cutoff(&self) -> f64 {
        self.cutoff
    }

    /// Divisors of the inputs (`n_in`).
    pub fn norm_in(&self) -> &[f64] {
        &self.norm_in
    }

    /// Factors of the predictions (`n_out`).
    pub fn norm_out(&self) -> &[f64] {
        &self.norm_out
    }

    /// The trustworthy receptive fields of one output; their predictions are weighted by their activations.
    ///
    /// # Panics
    /// If there is no such output.
    pub fn fields(&self, output: usize) -> impl Iterator<Item = LocalPrediction<'_>> {
        self.outputs[output].models.iter().filter_map(LocalModel::prediction)
    }

    /// Number of inputs.
    pub fn n_in(&self) -> usize {
        self.norm_in.len()
    }

    /// Number of outputs.
    pub fn n_out(&self) -> usize {
        self.norm_out.len()
    }

    fn ask(&self, x: DVectorView<'_, f64>, output: usize, wanted: Wanted<'_>) -> Option<f64> {
        assert!(output < self.n_out(), "there is no such output");
        if is_query(x, self.n_in()) { self.ask_checked(x, output, wanted) } else { None }
    }

    /// [`ask`](Self::ask) for an `x` that has been checked.
    fn ask_checked(&self, x: DVectorView<'_, f64>, output: usize, mut wanted: Wanted<'_>) -> Option<f64> {
        let (table, norm_out) = (&self.outputs[output].table, self.norm_out[output]);
        sweep(&Query { table, scale: &self.scale, x: x.as_slice(), norm_out }, &mut wanted)
    }

    fn check_queries(&self, xs: DMatrixView<'_, f64>) -> Result<(), LwprError> {
        if xs.nrows() != self.n_in() {
            return Err(LwprError::Dimension { side: Side::Input, found: xs.nrows(), expected: self.n_in() });
        }
        require_finite(xs, Side::Input)
    }
}
