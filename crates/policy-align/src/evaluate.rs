use gp::GpError;
use metrics::{MetricsError, ncpe, nupe};
use motion::{LearntPolicy, Policy};
use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use crate::along::{along, error_along_motion};
use crate::fit::rows;
use crate::{FitError, Model, Prepared};

/// Errors of a policy on movements.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Evaluation {
    /// Σ (uᵀπ̂/r − r)² / Σ r², r = ‖u‖: 0 means that every movement is predicted exactly, 1 is as good as standing still.
    pub slope_error: f64,
    /// The same sum of squares over Σ ‖π̂‖², which is meaningful even if constraints block most of the policy.
    pub policy_error: f64,
    /// [`Evaluation::slope_error`] of each movement, (K); `None` if it does not move.
    pub episodes: Vec<Option<f64>>,
    /// uᵀπ̂/r − r of every moving sample, ordered by movement and sample, (M' ≤ M); in units of the scaled state per second.
    pub residuals: Vec<f64>,
    /// Share of samples within the model's data: [`ModelPolicy::is_supported`](crate::ModelPolicy::is_supported).
    pub supported: f64,
    /// Error of the unconstrained policy; `None` without truth.
    pub nupe: Option<f64>,
    /// Error of the constrained policy; `None` without truth.
    pub ncpe: Option<f64>,
}

/// The true policy at every sample of every movement, in order.
#[derive(Debug, Clone, PartialEq)]
pub struct Truth {
    /// π at each sample, (n, M), times the channels' scales.
    pub actions: DMatrix<f64>,
    /// Projectors N at each sample, each (n, n), (M); `None` if unknown.
    pub projectors: Option<Vec<DMatrix<f64>>>,
}

/// Slope errors, residuals and support on other movements; with the truth also nUPE and nCPE.
///
/// # Errors
/// [`EvaluateError::Dimension`] if the policy has another dimension, [`EvaluateError::Gp`] if the movements cannot be cleaned;
/// [`EvaluateError::Projectors`] or [`EvaluateError::Metrics`] if the truth does not fit the movements.
pub fn evaluate(model: &Model, prepared: &Prepared, truth: Option<&Truth>) -> Result<Evaluation, EvaluateError> {
    let policy = model.learnt.policy();
    let dim = prepared.demonstrations.dim() + prepared.demonstrations.context_dim();
    if policy.dim() != dim {
        return Err(EvaluateError::Dimension { policy: policy.dim(), movements: dim });
    }
    let rows = rows(prepared)?;
    let all: Vec<usize> = (0..rows.len()).collect();
    let total = error_along_motion(policy, &rows, &all, None);
    let mut episodes = vec![None; prepared.demonstrations.n_trajectories()];
    let trajectory = |row: usize| rows.indices()[row].trajectory;
    for own in all.chunk_by(|&a, &b| trajectory(a) == trajectory(b)) {
        let error = error_along_motion(policy, &rows, own, None).relative_to_motion();
        episodes[trajectory(own[0])] = error.is_finite().then_some(error);
    }
    let (nupe, ncpe) = match truth {
        None => (None, None),
        Some(truth) => against(policy, prepared, truth)?,
    };
    Ok(Evaluation {
        slope_error: total.relative_to_motion(),
        policy_error: total.relative_to_policy(),
        episodes,
        residuals: along(policy, &rows).map(|row| row.predicted - row.speed).collect(),
        supported: supported(model, &rows),
        nupe,
        ncpe,
    })
}

/// Share of the rows' states at which the model supports its policy.
fn supported(model: &Model, rows: &gp::Rows) -> f64 {
    let policy = model.policy();
    let scales = model.input_scales();
    let states = DMatrix::from_fn(policy.dim(), rows.len(), |k, row| rows.states()[(k, row)] / scales[k]);
    let within = policy.are_supported(states.as_view()).into_iter().filter(|&supported| supported);
    within.count() as f64 / rows.len() as f64
}

fn against(
    policy: &dyn LearntPolicy,
    prepared: &Prepared,
    truth: &Truth,
) -> Result<(Option<f64>, Option<f64>), EvaluateError> {
    let demonstrations = &prepared.demonstrations;
    let (n, m) = (demonstrations.dim(), demonstrations.n_samples());
    let mut learnt = DMatrix::zeros(n, m);
    let states = demonstrations
        .trajectories()
        .iter()
        .flat_map(|movement| (0..movement.n_samples()).map(|sample| movement.state_in_context(sample)));
    for (state, mut action) in states.zip(learnt.column_iter_mut()) {
        action.copy_from(&policy.action(state.as_view()).rows(0, n));
    }
    let unconstrained = nupe(&truth.actions, &learnt)?;
    let constrained = match &truth.projectors {
        None => None,
        Some(projectors) if projectors.len() == m => Some(ncpe(&truth.actions, &learnt, |sample, mut difference| {
            let projected = &projectors[sample] * &difference;
            difference.copy_from(&projected);
        })?),
        Some(projectors) => return Err(EvaluateError::Projectors { found: projectors.len(), expected: m }),
    };
    Ok((Some(unconstrained), constrained))
}

/// Why a policy cannot be evaluated.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EvaluateError {
    /// Policy and movements have different dimensions.
    #[error("the policy has {policy} dimensions, the movements {movements}; use the channels it was learnt from")]
    Dimension {
        /// Dimension of the policy.
        policy: usize,
        /// Dimension of the movements.
        movements: usize,
    },
    /// The number of projectors differs from the number of samples.
    #[error("there are {found} projectors for {expected} samples; give one for each")]
    Projectors {
        /// Number of projectors.
        found: usize,
        /// Number of samples.
        expected: usize,
    },
    /// There are too few constraints to leave one out.
    #[error("the recordings name {found} constraint{}; --constraint-column with a column that names at least two", if *found == 1 { "" } else { "s" })]
    Constraints {
        /// Number of labels.
        found: usize,
    },
    /// The robot cannot take a state of the movements.
    #[error("the robot cannot be where a movement is: {reason}")]
    Robot {
        /// The robot model's error.
        reason: String,
    },
    /// Learning from the remaining movements fails.
    #[error(transparent)]
    Fit(#[from] FitError),
    /// The movements cannot be cleaned.
    #[error(transparent)]
    Gp(#[from] GpError),
    /// The truth does not fit the movements.
    #[error(transparent)]
    Metrics(#[from] MetricsError),
}
