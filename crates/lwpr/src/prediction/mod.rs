//! Prediction: value, gradient and confidence at an input.

mod confidence;
mod distance;
mod field_table;
mod hessian;
mod live;
mod local_model;
mod predictor;
mod query;
mod record;
mod sweep;
mod threads;

use nalgebra::{DMatrix, DVector, DVectorView};

pub use local_model::LocalPrediction;
pub use predictor::Predictor;
use sweep::Wanted;

/// Prediction at one input.
#[derive(Debug, Clone, PartialEq)]
pub struct Prediction {
    /// The prediction (`n_out`).
    pub value: DVector<f64>,
    /// Its derivative with respect to the input (`n_out`, `n_in`).
    pub gradient: DMatrix<f64>,
    /// Predictive standard deviation (`n_out`), in the units of the outputs; infinite if no field that takes part has
    /// collected errors yet (in its first hundred samples or so, with the default forgetting).
    pub confidence: DVector<f64>,
    /// Activation of the nearest receptive field (`n_out`), whether or not it takes part.
    pub max_activation: DVector<f64>,
}

impl Prediction {
    /// Memory for the predictions of a model with `n_in` inputs and `n_out` outputs; all zero.
    pub fn zeros(n_in: usize, n_out: usize) -> Self {
        Prediction {
            value: DVector::zeros(n_out),
            gradient: DMatrix::zeros(n_out, n_in),
            confidence: DVector::zeros(n_out),
            max_activation: DVector::zeros(n_out),
        }
    }

    /// Queries each output for everything. Returns whether all have support.
    fn fill_with(&mut self, n_in: usize, n_out: usize, mut ask: impl FnMut(usize, Wanted<'_>) -> Option<f64>) -> bool {
        assert_eq!(self.gradient.shape(), (n_out, n_in), "the prediction has the shape of the model");
        self.max_activation.fill(0.0);
        let mut supported = true;
        for output in 0..n_out {
            let wanted = Wanted {
                gradient: Some((&mut self.gradient.as_mut_slice()[output..], n_out)),
                hessian: None,
                confidence: Some(&mut self.confidence[output]),
                max_activation: Some(&mut self.max_activation[output]),
            };
            match ask(output, wanted) {
                Some(value) => self.value[output] = value,
                None => supported = false,
            }
        }
        supported
    }
}

/// Whether `x` is a valid query: `n_in` finite numbers.
fn is_query(x: DVectorView<'_, f64>, n_in: usize) -> bool {
    x.len() == n_in && are_finite(x.as_slice())
}

/// Whether all numbers are finite, computed without a branch for each.
fn are_finite(numbers: &[f64]) -> bool {
    numbers.iter().fold(true, |finite, number| finite & number.is_finite())
}
