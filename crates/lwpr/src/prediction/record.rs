//! The stored form of a predictor.

use serde::{Deserialize, Serialize};

use super::local_model::LocalModel;
use crate::Kernel;

/// All data from which a [`Predictor`](crate::Predictor) is made.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PredictorRecord {
    pub(super) kernel: Kernel,
    pub(super) cutoff: f64,
    pub(super) norm_in: Vec<f64>,
    pub(super) norm_out: Vec<f64>,
    pub(super) outputs: Vec<Vec<LocalModel>>,
}

impl PredictorRecord {
    pub(super) fn check(&self) -> Result<(), &'static str> {
        let n = self.norm_in.len();
        let positive = |norm: &[f64]| !norm.is_empty() && norm.iter().all(|&norm| norm > 0.0 && norm.is_finite());
        let models = || self.outputs.iter().flatten();
        let checks = [
            (self.cutoff >= 0.0, "the cutoff is not a number from 0 on"),
            (positive(&self.norm_in) && positive(&self.norm_out), "a norm is not positive and finite"),
            (self.outputs.len() == self.norm_out.len(), "the number of lists of fields is not that of the outputs"),
            (models().all(|model| model.has_shape(n)), "a field has not the shape of the inputs"),
            (self.outputs.iter().all(|models| have_one_shape(models)), "some fields turn, others do not"),
            (
                models().all(|model| model.has_shape(n) && model.is_sound()),
                "a field has a number that is not finite or too large, or a metric that is none",
            ),
        ];
        checks.into_iter().find(|(fine, _)| !fine).map_or(Ok(()), |(_, reason)| Err(reason))
    }
}

/// Whether the metrics are all diagonal or all full.
fn have_one_shape(models: &[LocalModel]) -> bool {
    models.windows(2).all(|pair| pair[0].metric.len() == pair[1].metric.len())
}
