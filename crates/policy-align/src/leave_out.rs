//! Cross-validation over constraints: does a policy learnt under some constraints hold under another?

use std::collections::BTreeSet;

use motion::Demonstrations;
use nalgebra::DVector;
use serde::{Deserialize, Serialize};

use crate::{EvaluateError, Evaluation, FitError, FitOptions, Model, Prepared, Progress, evaluate, fit};

/// Prediction of the movements under one constraint by the policy learnt under all others.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ConstraintLeftOut {
    /// Its label.
    pub constraint: String,
    /// Number of movements in the training set.
    pub learnt_from: usize,
    /// Evaluation of the policy learnt under the others.
    pub evaluation: Evaluation,
}

/// Learns without each constraint in turn and evaluates on it. Movements without a label are always in the training set.
/// The same seed gives the same bits.
///
/// # Errors
/// [`EvaluateError::Constraints`] if there are fewer than two labels, [`EvaluateError::Fit`] if the remaining movements
/// are too few to learn from, and those of [`evaluate`].
pub fn leave_constraints_out(
    prepared: &Prepared,
    options: &FitOptions,
    progress: &mut Progress<'_>,
) -> Result<Vec<ConstraintLeftOut>, EvaluateError> {
    let labels: BTreeSet<&String> = prepared.constraints.iter().flatten().collect();
    if labels.len() < 2 {
        return Err(EvaluateError::Constraints { found: labels.len() });
    }
    let without = |label: &String| {
        let (out, others): (Vec<usize>, Vec<usize>) =
            (0..prepared.constraints.len()).partition(|&k| prepared.constraints[k].as_ref() == Some(label));
        let learnt = fit(&only(prepared, &others), options, progress)?;
        let evaluation = evaluate(&learnt, &in_units_of(&learnt, &only(prepared, &out))?, None)?;
        Ok(ConstraintLeftOut { constraint: label.clone(), learnt_from: others.len(), evaluation })
    };
    labels.into_iter().map(without).collect()
}

/// Movements in the units of a model, which may have learnt them.
pub(crate) fn in_units_of(model: &Model, prepared: &Prepared) -> Result<Prepared, FitError> {
    let factors = model.state.iter().zip(&prepared.state).map(|(learnt, own)| learnt.scale / own.scale);
    let factors = DVector::from_iterator(prepared.state.len(), factors);
    let of_context = model.context.iter().zip(&prepared.context).map(|(learnt, own)| learnt.scale / own.scale);
    let prepared = prepared.with_context_scaled(&DVector::from_iterator(prepared.context.len(), of_context))?;
    if factors.iter().all(|&factor| factor == 1.0) {
        return Ok(prepared);
    }
    Ok(prepared.rescaled(&factors)?)
}

/// Some of the movements, with the preparation of all.
fn only(prepared: &Prepared, wanted: &[usize]) -> Prepared {
    let movements = wanted.iter().map(|&k| prepared.demonstrations.trajectories()[k].clone()).collect();
    Prepared {
        demonstrations: Demonstrations::new(movements).expect("movements of one dimension stay so"),
        episodes: wanted.iter().map(|&k| prepared.episodes[k].clone()).collect(),
        constraints: wanted.iter().map(|&k| prepared.constraints[k].clone()).collect(),
        ..prepared.clone()
    }
}
