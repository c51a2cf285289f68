use nalgebra::{DMatrix, DVector};
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize};

use crate::Kernel;

/// Shape of the distance metric D of every receptive field.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Metric {
    /// One width for each input: O(n) a sample and field.
    #[default]
    Diagonal,
    /// Fields may turn and stretch in any direction: O(n³) a sample and field.
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

/// Which of two overlapping receptive fields is removed when the activation of both exceeds `w_prune`.
///
/// Width is the trace of the metric D of *normalised* inputs, not of inputs in their own units.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Pruning {
    /// The wider one (smaller trace of D), as the C library does.
    #[default]
    Wider,
    /// The narrower one (larger trace of D), as the article and the library's manual say.
    Narrower,
}

/// Parameters of a model; the defaults are those of the C library.
///
/// Sizes speak of *normalised* data x/`norm_in`, y/`norm_out`.
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
    /// A sample that activates no field above this makes a new one; in (0, 1).
    pub w_gen: f64,
    /// Of two fields that one sample activates above this one is removed; in (0, 1], and 1 never removes any.
    pub w_prune: f64,
    /// Which of the two.
    pub pruning: Pruning,
    /// Forgetting factor λ of a new field; in [0.5, 1].
    pub init_lambda: f64,
    /// Forgetting factor that it approaches; in [0.5, 1].
    pub final_lambda: f64,
    /// How slowly: λ ← τλ + (1 − τ)·`final_lambda`; in (0, 1].
    pub tau_lambda: f64,
    /// A field gets another projection when the last one brought its error below this share of the one before.
    pub add_threshold: f64,
    /// Initial Σ w s² of a projection, which keeps its first divisions finite.
    pub init_s2: f64,
    /// Divisors of the inputs (`n_in`), `None` for ones: give the typical spread of each.
    pub norm_in: Option<DVector<f64>>,
    /// Divisors of the targets (`n_out`), `None` for ones: give their standard deviations.
    pub norm_out: Option<DVector<f64>>,
    /// Refuse samples that would need more receptive fields than this for one output; `None` for no limit.
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

/// A matrix as nalgebra writes it, numbers, rows, columns: its shape is checked before it is believed.
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
