//! Determines the noise factor κ by held-out prediction, because the marginal likelihood underestimates correlated noise.

use std::mem;

use linalg::Factor;
use nalgebra::DMatrix;

use crate::kernel::covariance::{NOISE_FLOOR, add_noise};
use crate::left_out::{LeftOutPredictions, left_out};

/// What a model predicts at its rows.
#[derive(Debug, Clone)]
pub(crate) struct Targets {
    /// y, (M, c), scaled.
    pub(crate) values: DMatrix<f64>,
    /// D, (M).
    pub(crate) noise_weights: Vec<f64>,
    /// Rows of each trajectory.
    pub(crate) groups: Vec<Vec<usize>>,
    /// Σ w|y|², with w = 1/D, about the prediction without a model: the reference of R².
    pub(crate) spread: f64,
}

/// A model at one noise level.
#[derive(Debug)]
pub(crate) struct Level {
    /// κ: factor on σ².
    pub(crate) kappa: f64,
    /// σ² by marginal likelihood.
    pub(crate) found: f64,
    /// σ² used, without the floor.
    pub(crate) noise: f64,
    pub(crate) factor: Factor,
    /// K⁻¹y, (M, c).
    pub(crate) weights: DMatrix<f64>,
    pub(crate) left_out: LeftOutPredictions,
}

/// Factors by which noise is increased.
pub(crate) fn kappas() -> impl Iterator<Item = f64> {
    (0..=10).map(|power| 4.0_f64.powi(power))
}

/// σ² increased by κ; κ = 1 leaves it unchanged.
pub(crate) fn raised(noise: f64, kappa: f64) -> f64 {
    if kappa == 1.0 { noise } else { (kappa * (noise + NOISE_FLOOR)).min(3.0_f64.exp()) }
}

impl Level {
    /// The model with noise κ(σ² + 1e-10), given Σ a_b K_b; `None` without a Cholesky factor.
    pub(crate) fn at(covariance: &DMatrix<f64>, found: f64, kappa: f64, targets: &Targets) -> Option<Self> {
        let mut inverse = DMatrix::zeros(covariance.nrows(), covariance.nrows());
        Level::reusing((covariance.clone(), &mut inverse), found, kappa, targets)
    }

    /// The same, given Σ a_b K_b, which becomes the factor, and a matrix of that size for L⁻¹ that is zero above the diagonal.
    fn reusing(
        (mut matrix, inverse): (DMatrix<f64>, &mut DMatrix<f64>),
        found: f64,
        kappa: f64,
        targets: &Targets,
    ) -> Option<Self> {
        let noise = raised(found, kappa);
        add_noise(&mut matrix, noise, targets.noise_weights.iter().copied());
        let factor = Factor::new(matrix)?;
        let mut weights = targets.values.clone();
        factor.solve(&mut weights);
        let Targets { groups, noise_weights, spread, .. } = targets;
        factor.inverse_triangle_into(inverse);
        let left_out = left_out(inverse, &weights, groups, noise_weights, *spread)?;
        Some(Level { kappa, found, noise, factor, weights, left_out })
    }

    /// The best κ, given Σ a_b K_b and the σ² found.
    pub(crate) fn best(covariance: &DMatrix<f64>, found: f64, targets: &Targets) -> Option<Self> {
        let zeros = || DMatrix::zeros(covariance.nrows(), covariance.ncols());
        let (mut inverse, mut kappas) = (zeros(), kappas());
        let next = |worse: Option<Level>| {
            // Matrices of many rows take less time to fill than to allocate.
            let mut matrix = worse.map_or_else(zeros, |level| level.factor.into_matrix());
            matrix.copy_from(covariance);
            Level::reusing((matrix, &mut inverse), found, kappas.next()?, targets)
        };
        climb(next, |level| &level.left_out)
    }
}

/// The level with the best R² among levels of increasing noise. Stops after two levels in a row without improvement, at a failed
/// level, or if prediction is already exact. `None` if the first level fails. `next` receives the worse of two levels to reuse
/// its memory.
pub(crate) fn climb<T>(
    mut next: impl FnMut(Option<T>) -> Option<T>,
    left_out: impl Fn(&T) -> &LeftOutPredictions,
) -> Option<T> {
    let mut best = next(None)?;
    if left_out(&best).is_exact() {
        return Some(best);
    }
    let (mut worse, mut in_a_row) = (None, 0);
    while in_a_row < 2 {
        let Some(level) = next(worse.take()) else { break };
        let better = left_out(&level).r_squared > left_out(&best).r_squared;
        worse = Some(if better { mem::replace(&mut best, level) } else { level });
        in_a_row = if better { 0 } else { in_a_row + 1 };
    }
    Some(best)
}
