use linalg::LaplacianFactor;

use super::group::Group;
use super::sparsifier::sparsifier;
use crate::AlignError;

/// An approximate factor of selected links of a group that represent all. It reduces the number of iterations and does
/// not affect their limit.
#[derive(Debug)]
pub(crate) struct Preconditioner {
    factor: LaplacianFactor,
}

impl Preconditioner {
    /// # Errors
    /// [`AlignError::NoConvergence`] if the weights cannot be factorised.
    pub(crate) fn new(group: &Group<'_>) -> Result<Self, AlignError> {
        let links = sparsifier(group).into_iter();
        let (ends, weights): (Vec<(u32, u32)>, Vec<f64>) = links.map(|(k, j, weight)| ((k, j), weight)).unzip();
        let (ones, others): (Vec<u32>, Vec<u32>) = ends.into_iter().unzip();
        let factor = LaplacianFactor::new(group.samples.n_trajectories, &ones, &others, &weights);
        Ok(Preconditioner { factor: factor.ok_or(AlignError::NoConvergence)? })
    }

    /// Applies an approximation of L⁺ to r, (K), in place; 0 outside the group. Does not allocate once `scratch` has
    /// grown.
    pub(crate) fn apply(&self, right: &mut [f64], scratch: &mut Vec<f64>) {
        self.factor.solve(right, scratch);
    }
}
