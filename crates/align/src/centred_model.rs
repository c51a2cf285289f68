use std::sync::Arc;

use lwpr::{Lwpr, LwprParams, Predictor};
use nalgebra::{DMatrix, DVector, DVectorView};
use rand::Rng;

use crate::AlignError;

/// How LWPR is trained and asked.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Training<'a> {
    pub(crate) params: &'a LwprParams,
    pub(crate) passes: usize,
    pub(crate) cutoff: f64,
}

/// LWPR on outputs that are centred and divided by their standard deviations.
#[derive(Debug, Clone)]
pub(crate) struct CentredModel {
    pub(crate) model: Arc<Lwpr>,
    pub(crate) predictor: Predictor,
    /// Means of the training outputs: the prediction where there is no support.
    pub(crate) mean: DVector<f64>,
}

impl CentredModel {
    /// Learns `outputs` (n_out, M) from `states` (n, M), in a fresh random order each pass.
    pub(crate) fn fit(
        training: Training<'_>,
        states: &DMatrix<f64>,
        mut outputs: DMatrix<f64>,
        mut rng: &mut dyn Rng,
    ) -> Result<Self, AlignError> {
        check_cutoff(training.cutoff)?;
        if training.passes == 0 {
            return Err(AlignError::Parameter { name: "passes", value: 0.0, requirement: "be at least 1" });
        }
        if states.ncols() == 0 {
            return Err(AlignError::NoSamples);
        }
        let mean = DVector::from_iterator(outputs.nrows(), outputs.row_iter().map(|row| mean(row.iter())));
        outputs.column_iter_mut().for_each(|mut column| column -= &mean);
        let spread = DVector::from_iterator(outputs.nrows(), outputs.row_iter().map(|row| spread(row.iter())));
        let params = LwprParams { norm_out: Some(spread), ..training.params.clone() };
        let mut model = params.build(states.nrows(), outputs.nrows())?;
        model.fit_batch(states.as_view(), outputs.as_view(), training.passes, &mut rng)?;
        Ok(CentredModel { predictor: model.predictor(training.cutoff), model: Arc::new(model), mean })
    }

    /// The largest activation of a receptive field at this state, (n), for the output that has least of it; 0 if no
    /// field takes part in the prediction of some output.
    pub(crate) fn support(&self, state: DVectorView<'_, f64>) -> f64 {
        let of = |output| {
            let takes_part = self.predictor.value(state, output).is_some();
            if takes_part { self.predictor.max_activation(state, output) } else { 0.0 }
        };
        (0..self.mean.len()).map(of).fold(f64::INFINITY, f64::min)
    }

    /// The same model, asked with another cutoff.
    pub(crate) fn with_cutoff(&self, cutoff: f64) -> Result<Self, AlignError> {
        check_cutoff(cutoff)?;
        Ok(CentredModel { predictor: self.model.predictor(cutoff), ..self.clone() })
    }
}

fn check_cutoff(cutoff: f64) -> Result<(), AlignError> {
    if (0.0..1.0).contains(&cutoff) {
        return Ok(());
    }
    Err(AlignError::Parameter { name: "cutoff", value: cutoff, requirement: "be at least 0 and less than 1" })
}

/// Divided before it is summed, since a sum of finite values may overflow.
fn mean<'a>(values: impl ExactSizeIterator<Item = &'a f64>) -> f64 {
    let count = values.len() as f64;
    values.map(|value| value / count).sum()
}

/// Standard deviation of centred values; 1 where they are all equal, so that it can divide.
fn spread<'a>(values: impl ExactSizeIterator<Item = &'a f64> + Clone) -> f64 {
    let count = values.len() as f64;
    let largest = values.clone().fold(0.0_f64, |largest, value| largest.max(value.abs()));
    if largest == 0.0 {
        return 1.0;
    }
    let mean_square = values.map(|value| (value / largest).powi(2)).sum::<f64>() / count;
    largest * mean_square.sqrt()
}
