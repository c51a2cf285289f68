//! Stored fits: the parameters of their policies, to the last bit. The Cholesky factor, which only the uncertainty needs, is computed
//! on first use.

mod direct;
mod slope;

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use crate::GpError;
use crate::kernel::lazy_factor::LazyFactor;
use crate::kernel::triangle::Upper;
use crate::kernel::whitening::Whitening;
use crate::rows::MOST_ROWS;
use crate::rows::scaling::Scaling;

/// Versions of the record: models of rows, and models of inducing rows.
const ROWS: u32 = 1;
const INDUCING: u32 = 2;

/// Maximum dimension of a state, because a policy has matrices of its square.
const MOST_DIMENSIONS: usize = 2_000;

/// Numbers common to both kinds of model; matrices are stored column by column.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Stored<B> {
    version: u32,
    dim: usize,
    scaling: Scaling,
    /// Unit of speed.
    unit: f64,
    blocks: Vec<(B, f64)>,
    noise: f64,
    /// z, (n + p, M): states with their contexts.
    states: Vec<f64>,
    /// D, (M); empty for inducing rows.
    noise_weights: Vec<f64>,
    /// The triangle of (S37), column by column down to the diagonal; empty if all rows are in the model.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    shrinkage: Vec<f64>,
    /// (M) for slopes, (n, M) for velocities.
    weights: Vec<f64>,
}

impl<B> Stored<B> {
    /// Checks the record. Returns the number of rows M and the dimension n of the state, to which `vectors` belong, (n, M); the rest
    /// of `dim` is context.
    fn check(&self, vectors: &[f64], weights_a_row: impl FnOnce(usize) -> usize) -> Result<(usize, usize), GpError> {
        let inducing = self.version == INDUCING;
        let of_states = self.states.len().checked_div(self.dim).unwrap_or(0);
        let rows = if inducing { of_states } else { self.noise_weights.len() };
        let said = if inducing { (0, rows.saturating_mul(rows + 1) / 2) } else { (rows, 0) };
        let moving = vectors.len().checked_div(rows).unwrap_or(0);
        let weights_a_row = weights_a_row(moving);
        let finite = |numbers: &[f64]| numbers.iter().all(|number| number.is_finite());
        let positive = |number: f64| number > 0.0 && number.is_finite();
        let amplitudes = || self.blocks.iter().map(|(_, amplitude)| *amplitude);
        let checks = [
            (inducing || self.version == ROWS, "it has another version than 1 or 2; use a newer program"),
            (self.dim > 0 && rows > 0 && !self.blocks.is_empty(), "it is empty"),
            (rows <= MOST_ROWS, "it has more than 10000 rows, whose error bars would need over 0.8 GB; fit with fewer"),
            (self.dim <= MOST_DIMENSIONS, "its states have more than 2000 dimensions"),
            (self.scaling.mean.len() == self.dim, "the mean has not one number a dimension"),
            (self.states.len() == rows.saturating_mul(self.dim), "the number of states is not that of the rows"),
            (self.noise_weights.len() == said.0, "the number of noise weights is not that of the rows"),
            (self.shrinkage.len() == said.1, "the triangle that summarises the rows has another size"),
            (vectors.len() == rows.saturating_mul(moving), "the number of vectors is not that of the rows"),
            ((1..=self.dim).contains(&moving), "vectors and states do not fit"),
            (self.weights.len() == rows.saturating_mul(weights_a_row), "the number of weights is not that of the rows"),
            (
                finite(&self.states) && finite(&self.weights) && finite(&self.shrinkage) && finite(&self.scaling.mean),
                "a number is not finite",
            ),
            (positive(self.scaling.scale) && positive(self.unit), "a unit is not positive"),
            (amplitudes().all(|a| a >= 0.0 && a.is_finite()), "an amplitude is negative or not finite"),
            (self.noise >= 0.0 && self.noise.is_finite(), "the noise is negative or not finite"),
            (self.noise_weights.iter().all(|&weight| positive(weight)), "a noise weight is not positive"),
        ];
        match checks.into_iter().find(|(fine, _)| !fine) {
            None => Ok((rows, moving)),
            Some((_, reason)) => Err(stored(reason)),
        }
    }
}

/// Version, noise weights and triangle of a model.
fn of_whitening(whitening: &Whitening) -> (u32, Vec<f64>, Vec<f64>) {
    match whitening {
        Whitening::Rows { noise_weights, .. } => (ROWS, noise_weights.clone(), Vec::new()),
        Whitening::Inducing { shrinkage, .. } => (INDUCING, Vec::new(), shrinkage.entries().collect()),
    }
}

/// Creates the whitening from the values that [`Stored::check`] accepted.
fn whitening(rows: usize, noise_weights: Vec<f64>, shrinkage: &[f64]) -> Whitening {
    let factor = LazyFactor::default();
    if shrinkage.is_empty() {
        return Whitening::Rows { noise_weights, factor };
    }
    let entry = |row: usize, k: usize| if row <= k { shrinkage[k * (k + 1) / 2 + row] } else { 0.0 };
    Whitening::Inducing { shrinkage: Upper::new(&DMatrix::from_fn(rows, rows, entry)), factor }
}

fn stored(reason: &str) -> GpError {
    GpError::Stored { reason: reason.to_owned() }
}

/// Refuses scales outside 1e-9 to 1e9.
fn check_scales(mut scales: impl Iterator<Item = f64>) -> Result<(), GpError> {
    if scales.all(|scale| scale > 1e-9 && scale < 1e9) {
        Ok(())
    } else {
        Err(stored("a block's scale is not between 1e-9 and 1e9"))
    }
}
