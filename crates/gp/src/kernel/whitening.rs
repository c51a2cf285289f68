//! The share of a function's prior variance that the rows of a model explain.

use crate::kernel::covariance::{Covariance, add_noise, among, jittered};
use crate::kernel::lazy_factor::LazyFactor;
use crate::kernel::panel::Panel;
use crate::kernel::triangle::Upper;

/// Turns covariances B of a function with a model's rows into numbers whose squares sum to the explained variance.
#[derive(Debug, Clone)]
pub(crate) enum Whitening {
    /// L⁻¹B, where LLᵀ is the covariance of the rows with noise (S6); D is `noise_weights`, (M).
    Rows { noise_weights: Vec<f64>, factor: LazyFactor },
    /// TL⁻¹B, where LLᵀ is the covariance of the inducing rows (S34) and T, (m, m), an upper triangle of (S37).
    Inducing { shrinkage: Upper, factor: LazyFactor },
}

impl Whitening {
    /// Replaces B, (M, k), in M² operations per column. `covariance` is that of the model's rows, `noise` is σ² without the
    /// floor.
    pub(crate) fn apply(&self, b: &mut Panel, covariance: &impl Covariance, amplitudes: &[f64], noise: f64) {
        match self {
            Whitening::Rows { noise_weights, factor } => factor.whiten(b, || {
                let mut matrix = covariance.sum(amplitudes);
                add_noise(&mut matrix, noise, noise_weights.iter().copied());
                matrix
            }),
            Whitening::Inducing { shrinkage, factor } => {
                let rows: Vec<usize> = (0..b.rows()).collect();
                factor.whiten(b, || jittered(among(covariance, &rows, amplitudes)));
                shrinkage.apply(b);
            }
        }
    }
}
