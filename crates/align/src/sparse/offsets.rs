use nalgebra::DVector;

use super::conjugate_gradients::{centre, solve};
use super::group::Group;
use super::preconditioner::Preconditioner;
use super::shared_samples::SharedSamples;
use crate::AlignError;

/// Residuals after each round: the first two rounds solve, the others reduce rounding errors.
const REDUCTIONS: [f64; 5] = [1e-9, 1e-9, 1e-5, 1e-5, 1e-5];
/// The iteration ends after a step that is this small relative to the offsets; the remaining error is 1e-16 of them.
const LAST: f64 = 1e-11;

/// The offsets b = −H⁺a (17) of a group of trajectories, in the order of the group and with sum 0, from the mutual
/// weights of its members.
///
/// After each solution, the right-hand side a is computed again from the shifted values f + b, as in the dense
/// alignment.
pub(crate) fn offsets(
    samples: &SharedSamples,
    members: &[usize],
    preconditioner: Option<Preconditioner>,
) -> Result<DVector<f64>, AlignError> {
    if members.len() == 1 {
        return Ok(DVector::zeros(1));
    }
    let group = Group::new(samples, members);
    let preconditioner = preconditioner.map_or_else(|| Preconditioner::new(&group), Ok)?;
    let mut offsets = vec![0.0; samples.n_trajectories];
    for reduction in REDUCTIONS {
        let right: Vec<f64> = group.linear_term(&offsets).into_iter().map(|term| -term).collect();
        let finite = |&&k: &&usize| !right[k].is_finite();
        if let Some(&trajectory) = members.iter().find(finite) {
            return Err(AlignError::OffsetOverflow { trajectory });
        }
        // In units in which no square overflows or underflows.
        let unit = largest(&right);
        if unit == 0.0 {
            break;
        }
        let mut step = solve(&group, &preconditioner, right.iter().map(|term| term / unit).collect(), reduction)?;
        for (offset, step) in offsets.iter_mut().zip(&mut step) {
            *step *= unit;
            *offset += *step;
        }
        if largest(&step) <= LAST * largest(&offsets) {
            break;
        }
    }
    centre(&group, &mut offsets);
    if let Some(&trajectory) = members.iter().find(|&&k| !offsets[k].is_finite()) {
        return Err(AlignError::OffsetOverflow { trajectory });
    }
    Ok(DVector::from_iterator(members.len(), members.iter().map(|&k| offsets[k])))
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |largest, value| largest.max(value.abs()))
}
