//! LWPR on standardised outputs.

mod record;

use std::sync::Arc;

use nalgebra::{DMatrixView, DVector, DVectorView, DVectorViewMut};
use rand::Rng;
use serde::{Deserialize, Serialize};

use crate::settings::require_finite;
use crate::standardised::record::StandardisedRecord;
use crate::{Lwpr, LwprError, LwprParams, Predictor, Side};

/// Training of LWPR on standardised outputs, and the cutoff of its predictions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Training {
    /// Parameters of LWPR. If `norm_out` is `None`, each output is divided by its standard deviation; ones leave the
    /// outputs unchanged.
    pub params: LwprParams,
    /// Number of passes over all samples, each in a new random order; 10 by default.
    pub passes: usize,
    /// Receptive fields take part in a prediction if their activation exceeds this; in [0, 1), 1e-3 by default.
    pub cutoff: f64,
}

impl Default for Training {
    fn default() -> Self {
        Training { params: LwprParams::default(), passes: 10, cutoff: 1e-3 }
    }
}

impl Training {
    /// Learns `ys` (`n_out`, N) from `xs` (`n_in`, N); samples are columns.
    ///
    /// # Errors
    /// [`LwprError::Parameter`] for `passes`, `cutoff` or a parameter out of range, [`LwprError::EmptyBatch`], and the
    /// errors of [`LwprParams::build`] and [`Lwpr::fit_batch`].
    pub fn fit<R: Rng + ?Sized>(
        &self,
        xs: DMatrixView<'_, f64>,
        ys: DMatrixView<'_, f64>,
        rng: &mut R,
    ) -> Result<StandardisedModel, LwprError> {
        check_cutoff(self.cutoff)?;
        if self.passes == 0 {
            return Err(LwprError::Parameter { name: "passes", value: 0.0, range: "at least 1" });
        }
        if ys.ncols() == 0 {
            return Err(LwprError::EmptyBatch);
        }
        // Checked before centring, which would spread one bad value over all samples of its output.
        require_finite(ys, Side::Output)?;
        let mean = DVector::from_iterator(ys.nrows(), ys.row_iter().map(|row| mean(row.iter().copied())));
        let mut centred = ys.into_owned();
        centred.column_iter_mut().for_each(|mut column| column -= &mean);
        let spreads = || {
            let each = centred.row_iter().zip(&mean).map(|(row, &mean)| spread(row.iter().copied(), mean));
            DVector::from_iterator(centred.nrows(), each)
        };
        let norm_out = self.params.norm_out.clone().unwrap_or_else(spreads);
        let params = LwprParams { norm_out: Some(norm_out), ..self.params.clone() };
        let mut model = params.build(xs.nrows(), ys.nrows())?;
        model.fit_batch(xs, centred.as_view(), self.passes, rng)?;
        Ok(StandardisedModel::new(Arc::new(model), mean, self.cutoff))
    }
}

/// LWPR on outputs that are centred and divided by `norm_out`, by default their standard deviations.
///
/// It can be stored with serde: version, cutoff, means and the model. After reading, it predicts the same bits.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(try_from = "StandardisedRecord", into = "StandardisedRecord")]
pub struct StandardisedModel {
    model: Arc<Lwpr>,
    predictor: Predictor,
    mean: DVector<f64>,
    cutoff: f64,
}

impl StandardisedModel {
    /// From checked parts.
    pub(crate) fn new(model: Arc<Lwpr>, mean: DVector<f64>, cutoff: f64) -> Self {
        StandardisedModel { predictor: model.predictor(cutoff), model, mean, cutoff }
    }

    /// The same model with another cutoff: receptive fields take part if their activation exceeds `cutoff`. Roll-outs that
    /// leave the data need a tiny one, 1e-9.
    ///
    /// # Errors
    /// [`LwprError::Parameter`] if `cutoff` is not at least 0 and less than 1.
    pub fn with_cutoff(&self, cutoff: f64) -> Result<Self, LwprError> {
        check_cutoff(cutoff)?;
        Ok(Self::new(self.model.clone(), self.mean.clone(), cutoff))
    }

    /// Number of inputs.
    pub fn n_in(&self) -> usize {
        self.model.n_in()
    }

    /// Number of outputs.
    pub fn n_out(&self) -> usize {
        self.model.n_out()
    }

    /// Means of the training outputs (`n_out`): the predictions without support.
    pub fn mean(&self) -> &DVector<f64> {
        &self.mean
    }

    /// The activation above which receptive fields take part.
    pub fn cutoff(&self) -> f64 {
        self.cutoff
    }

    /// The underlying model, which learnt y − mean.
    pub fn model(&self) -> &Lwpr {
        &self.model
    }

    /// The predictor of y − mean.
    pub fn predictor(&self) -> &Predictor {
        &self.predictor
    }

    /// Whether a receptive field takes part in the prediction of `output` at `x` (`n_in`).
    ///
    /// # Panics
    /// If there is no such output.
    pub fn supports(&self, x: DVectorView<'_, f64>, output: usize) -> bool {
        self.predictor.value(x, output).is_some()
    }

    /// Prediction of one output at `x` (`n_in`); the output's mean without support.
    ///
    /// # Panics
    /// If there is no such output.
    pub fn value(&self, x: DVectorView<'_, f64>, output: usize) -> f64 {
        self.mean[output] + self.predictor.value(x, output).unwrap_or(0.0)
    }

    /// The derivative of one output with respect to the input (`n_in`), written into `gradient`; zero without support.
    ///
    /// # Panics
    /// If there is no such output, or `gradient` does not have `n_in` elements.
    pub fn gradient_into(&self, x: DVectorView<'_, f64>, output: usize, mut gradient: DVectorViewMut<'_, f64>) {
        if self.predictor.value_and_gradient_into(x, output, gradient.as_view_mut()).is_none() {
            gradient.fill(0.0);
        }
    }
}

pub(crate) fn check_cutoff(cutoff: f64) -> Result<(), LwprError> {
    if (0.0..1.0).contains(&cutoff) {
        return Ok(());
    }
    Err(LwprError::Parameter { name: "cutoff", value: cutoff, range: "at least 0 and less than 1" })
}

/// Divides before summing, because a sum of finite values may overflow.
fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    values.map(|value| value / count).sum()
}

/// Maximum relative difference between equal values and their mean.
const ROUNDING: f64 = 1e-13;

/// Standard deviation of values from which their mean was subtracted; 1 if they are all equal, because it is a divisor.
fn spread(values: impl ExactSizeIterator<Item = f64> + Clone, mean: f64) -> f64 {
    let count = values.len() as f64;
    let largest = values.clone().fold(0.0_f64, |largest, value| largest.max(value.abs()));
    if largest <= ROUNDING * mean.abs() {
        return 1.0;
    }
    let mean_square = values.map(|value| (value / largest).powi(2)).sum::<f64>() / count;
    largest * mean_square.sqrt()
}
