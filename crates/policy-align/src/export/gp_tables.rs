use gp::{Block, DirectBlock, Shape};
use nalgebra::{DMatrix, DVector};

use super::error::ExportError;
use super::tables::{StoredGp, StoredSlope};

/// Scaled coordinates z = (x − mean) / spread, and the learnt states in them, (n, M).
pub(super) struct Scaled {
    pub(super) mean: Vec<f64>,
    pub(super) spread: f64,
    pub(super) speed: f64,
    pub(super) z: DMatrix<f64>,
    /// A state counts as known within this squared distance of a learnt one, in scaled coordinates.
    pub(super) squared_radius: f64,
}

/// A term that falls with distance, at a length.
#[derive(Clone, Copy)]
pub(super) struct Term {
    pub(super) fall: Fall,
    pub(super) length: f64,
    pub(super) amplitude: f64,
}

/// How it falls.
#[derive(Clone, Copy)]
pub(super) enum Fall {
    Shape(Shape),
    DivergenceFree,
}

/// The slope GP's mean: π = speed (Σ g v − h (vᵀa) a + c + Q z), a = z − z', v = α n.
pub(super) struct SlopeTables {
    pub(super) scaled: Scaled,
    /// v, (n, M).
    pub(super) directions: DMatrix<f64>,
    pub(super) terms: Vec<Term>,
    /// c, (n).
    pub(super) constant: DVector<f64>,
    /// Q, (n, n).
    pub(super) matrix: DMatrix<f64>,
    pub(super) has_potential: bool,
}

/// The direct GP's mean: û = unit Σ k(z, z') A.
pub(super) struct DirectTables {
    pub(super) scaled: Scaled,
    /// A, (n, M).
    pub(super) weights: DMatrix<f64>,
    pub(super) terms: Vec<Term>,
    /// Factors of 1, of zᵀz' and of its square.
    pub(super) trend: [f64; 3],
}

/// ℓ = s √(2n).
fn length(scale: f64, dim: usize) -> f64 {
    scale * (2.0 * dim as f64).sqrt()
}

impl Scaled {
    fn new<B>(stored: &StoredGp<B>, squared_radius: impl FnOnce(&Scaled) -> f64) -> Result<Self, ExportError> {
        let (dim, numbers) = (stored.dim, stored.states.len());
        if stored.scaling.mean.len() != dim || numbers == 0 || !numbers.is_multiple_of(dim) {
            return Err(ExportError::Form { reason: "not one state a row".to_owned() });
        }
        let mut scaled = Scaled {
            mean: stored.scaling.mean.clone(),
            spread: stored.scaling.scale,
            speed: stored.unit,
            z: DMatrix::from_column_slice(dim, numbers / dim, &stored.states),
            squared_radius: 0.0,
        };
        scaled.squared_radius = squared_radius(&scaled);
        Ok(scaled)
    }
}

impl SlopeTables {
    pub(super) fn new(stored: StoredSlope, squared_radius: impl FnOnce(&Scaled) -> f64) -> Result<Self, ExportError> {
        let StoredSlope { slope_gp, directions } = stored;
        let scaled = Scaled::new(&slope_gp, squared_radius)?;
        let (n, rows) = scaled.z.shape();
        if directions.len() != n * rows || slope_gp.weights.len() != rows {
            return Err(ExportError::Form { reason: "not one direction and one weight a row".to_owned() });
        }
        let directions = DMatrix::from_fn(n, rows, |k, row| slope_gp.weights[row] * directions[row * n + k]);
        let outer = &directions * scaled.z.transpose();
        let (mut constant, mut matrix) = (DVector::zeros(n), DMatrix::zeros(n, n));
        let (mut terms, dim) = (Vec::new(), n as f64);
        for &(block, amplitude) in slope_gp.blocks.iter().filter(|(_, amplitude)| *amplitude > 0.0) {
            let term = |fall, scale| Term { fall, length: length(scale, n), amplitude };
            match block {
                Block::Linear => constant += directions.column_sum() * amplitude,
                Block::Quadratic => matrix += (&outer + outer.transpose()) * (amplitude / (dim + 1.0)),
                Block::Skew => matrix += (&outer - outer.transpose()) * (amplitude / (dim - 1.0).max(1.0)),
                Block::Potential(shape, scale) => terms.push(term(Fall::Shape(shape), scale)),
                Block::DivergenceFree(scale) => terms.push(term(Fall::DivergenceFree, scale)),
            }
        }
        let has_potential = slope_gp.blocks.iter().all(|(block, _)| block.has_potential());
        Ok(SlopeTables { scaled, directions, terms, constant, matrix, has_potential })
    }
}

impl DirectTables {
    pub(super) fn new(
        stored: StoredGp<DirectBlock>,
        squared_radius: impl FnOnce(&Scaled) -> f64,
    ) -> Result<Self, ExportError> {
        let scaled = Scaled::new(&stored, squared_radius)?;
        let (n, rows) = scaled.z.shape();
        if stored.weights.len() != n * rows {
            return Err(ExportError::Form { reason: "not n weights a row".to_owned() });
        }
        let (mut terms, mut trend, dim) = (Vec::new(), [0.0; 3], n as f64);
        for &(block, amplitude) in stored.blocks.iter().filter(|(_, amplitude)| *amplitude > 0.0) {
            match block {
                DirectBlock::Constant => trend[0] += amplitude,
                DirectBlock::Linear => trend[1] += amplitude / dim,
                DirectBlock::Quadratic => trend[2] += amplitude / (dim * dim),
                DirectBlock::Shape(shape, scale) => {
                    terms.push(Term { fall: Fall::Shape(shape), length: length(scale, n), amplitude });
                }
            }
        }
        Ok(DirectTables { scaled, weights: DMatrix::from_vec(n, rows, stored.weights), terms, trend })
    }
}
