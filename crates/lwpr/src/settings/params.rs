use nalgebra::{DMatrix, DVector};
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize};

use crate::Kernel;

/// Shape of the distance metric D of every receptive field.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Metric {
    /// One width for each input: O(n) per sample and field.
    #[default]
    Diagonal,
    /// Fields may be rotated and stretched in any direction: O(n³) per sample and field.
    Full,
}

/// Adaptation of the fields' shapes.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub enum MetricAdaptation {
    /// Fields keep their initial metric.
    Fixed,
    /// Stochastic gradient descent on the leave-one-out error with the fixed rate `init_alpha`.
    #[default]
    Gradient,
    /// The same with an individual rate for each element, adapted by incremental delta-bar-delta (IDBD).
    Meta {
        /// Learning rate of the logarithm of the learning rates (library: 250).
        rate: f64,
    },
}

/// The choice of which of two overlapping receptive fields is removed when the activation of both exceeds `w_prune`.
///
/// Width is the trace of the metric D of *normalised* inputs, not of inputs in their own units.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Pruning {
    /// The wider one (smaller trace of D), as in the C library.
    #[default]
    Wider,
    /// The narrower one (larger trace of D), as stated in the article and the library's manual.
    Narrower,
}

/// Parameters of a model; the defaults are those of the C library.
///
/// Sizes refer to *normalised* data x/`norm_in`, y/`norm_out`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LwprParams {
    /// Initial metric D = `init_d`·I: a field's standard deviation is 1/√`init_d`.
    pub init_d: f64,
    /// Initial metric D (`n_in`, `n_in`), symmetric positive definite; overrides `init_d`.
    #[serde(deserialize_with = "matrix")]
    pub init_metric: Option<DMatrix<f64>>,
    /// Learning rate of the metric, for every element.
    pub init_alpha: f64,
    /// Diagonal or full.
    pub metric: Metric,
    /// Adaptation of the metric.
    pub adaptation: MetricAdaptation,
    /// Shape of a receptive field.
    pub kernel: Kernel,
    /// Weight γ of the penalty on large metrics, which keeps fields from shrinking to points.
    pub penalty: f64,
    /// A sample that activates no field above this value creates a new one; in (0, 1).
    pub w_gen: f64,
    /// If one sample activates two fields above this value, one of them is removed; in (0, 1], and 1 never removes any.
    pub w_prune: f64,
    /// The field to remove.
    pub pruning: Pruning,
    /// Forgetting factor λ of a new field; in [0.5, 1].
    pub init_lambda: f64,
    /// Forgetting factor that it approaches; in [0.5, 1].
    pub final_lambda: f64,
    /// Rate of this approach: λ ← τλ + (1 − τ)·`final_lambda`; in (0, 1].
    pub tau_lambda: f64,
    /// A field gets another projection if the last one reduced its error to less than this share of the previous error.
    pub add_threshold: f64,
    /// Initial Σ w s² of a projection, which keeps its first divisions finite.
    pub init_s2: f64,
    /// Divisors of the inputs (`n_in`), `None` for ones; use the typical spread of each.
    pub norm_in: Option<DVector<f64>>,
    /// Divisors of the targets (`n_out`), `None` for ones; use their standard deviations.
    pub norm_out: Option<DVector<f64>>,
    /// Maximum number of receptive fields per output; samples that would need more are refused. `None` for no limit.
    pub max_receptive_fields: Option<usize>,
}

impl Default for LwprParams {
    fn default() -> Self {
        LwprParams {
            init_d: 25.0,
            init_metric: None,
            init_alpha: 50.0,
            metric: Metric::default(),
            adaptation: MetricAdaptation::default(),
            kernel: Kernel::default(),
            penalty: 1e-6,
            w_gen: 0.1,
            w_prune: 1.0,
            pruning: Pruning::default(),
            init_lambda: 0.999,
            final_lambda: 0.99999,
            tau_lambda: 0.9999,
            add_threshold: 0.5,
            init_s2: 1e-10,
            norm_in: None,
            norm_out: None,
            max_receptive_fields: None,
        }
    }
}

/// A matrix in nalgebra's form: numbers, rows, columns. Its shape is checked first.
fn matrix<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<DMatrix<f64>>, D::Error> {
    let Some((numbers, rows, columns)) = Option::<(Vec<f64>, usize, usize)>::deserialize(deserializer)? else {
        return Ok(None);
    };
    if rows.checked_mul(columns) != Some(numbers.len()) {
        let found = numbers.len();
        return Err(D::Error::custom(format!("a matrix of shape ({rows}, {columns}) with {found} numbers")));
    }
    Ok(Some(DMatrix::from_vec(rows, columns, numbers)))
}
