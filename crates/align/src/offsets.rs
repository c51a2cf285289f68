use nalgebra::{DMatrix, DVector};

use crate::AlignError;
use crate::laplacian::{Elimination, of_group};
use crate::linear_term::linear_term;
use crate::responsibilities::Responsibilities;

/// The first solution is good to 1e-16 / λ₂; the second levels what that left.
const ROUNDS: usize = 2;

/// The offsets b = −H⁺a (17) of a group of trajectories, in the order of the group and with sum 0, by the mutual
/// weights of its members.
///
/// The right-hand side a is evaluated anew from the raised values, f + b, after each solution: what remains to be
/// levelled is small there, and so is its rounding error.
pub(crate) fn group_offsets(
    responsibilities: &Responsibilities,
    laplacian: &DMatrix<f64>,
    group: &[usize],
) -> Result<DVector<f64>, AlignError> {
    let elimination = Elimination::new(&of_group(laplacian, group));
    let mut offsets = vec![None; laplacian.ncols()];
    group.iter().for_each(|&k| offsets[k] = Some(0.0));
    for _ in 0..ROUNDS {
        let (linear, _) = linear_term(responsibilities, &offsets);
        let left: Vec<f64> = group.iter().map(|&k| -linear[k]).collect();
        for (&k, step) in group.iter().zip(elimination.solve(&left)) {
            offsets[k] = offsets[k].map(|offset| offset + step);
        }
    }
    let offsets: Vec<f64> = group.iter().filter_map(|&k| offsets[k]).collect();
    match offsets.iter().position(|offset| !offset.is_finite()) {
        None => Ok(offsets.into()),
        Some(at) => Err(AlignError::OffsetOverflow { trajectory: group[at] }),
    }
}
