use nalgebra::{DVector, DVectorView};
use serde::{Deserialize, Serialize};

use crate::kernel::shape::{Radial, Shape, divergence_free_at};

/// One term of the slope GP's prior with its amplitude: a covariance of slopes nᵀπ, and of the potential.
///
/// Distances are in scaled coordinates z; a scale s stands for the length ℓ = s √(2n), n the dimension of the state.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Block {
    /// Potentials linear in the state: constant policies.
    Linear,
    /// Quadratic potentials.
    Quadratic,
    /// Potentials of this shape and scale.
    Potential(Shape, f64),
    /// Policies Sz with S skew: rotation without a potential. Not in one dimension.
    Skew,
    /// Policies without divergence at this scale, squared exponential. Not in one dimension.
    DivergenceFree(f64),
}

impl Block {
    /// Whether policies drawn from this block have a potential.
    pub fn has_potential(self) -> bool {
        !matches!(self, Block::Skew | Block::DivergenceFree(_))
    }

    /// (S3): covariance of the slopes along `n` at `z` and along `n2` at `z2`, all (n).
    pub fn slope_slope(
        self,
        z: DVectorView<'_, f64>,
        n: DVectorView<'_, f64>,
        z2: DVectorView<'_, f64>,
        n2: DVectorView<'_, f64>,
    ) -> f64 {
        let nu = n.dot(&n2);
        let along = || n.dot(&z2) * n2.dot(&z);
        let dim = z.len();
        match self {
            Block::Linear => nu,
            Block::Quadratic => (nu * z.dot(&z2) + along()) / (dim as f64 + 1.0),
            Block::Skew => (nu * z.dot(&z2) - along()) / (dim as f64 - 1.0).max(1.0),
            Block::Potential(..) | Block::DivergenceFree(_) => {
                let (apart, g, h) = self.falling(z, z2);
                g * nu - h * n.dot(&apart) * n2.dot(&apart)
            }
        }
    }

    /// Covariance of the policy at `z` and the slope along `n2` at `z2`, (n): (S3) with `n` each unit vector in turn.
    pub fn policy_slope(
        self,
        z: DVectorView<'_, f64>,
        z2: DVectorView<'_, f64>,
        n2: DVectorView<'_, f64>,
    ) -> DVector<f64> {
        let dim = z.len() as f64;
        match self {
            Block::Linear => n2.clone_owned(),
            Block::Quadratic => (n2 * z.dot(&z2) + z2 * n2.dot(&z)) / (dim + 1.0),
            Block::Skew => (n2 * z.dot(&z2) - z2 * n2.dot(&z)) / (dim - 1.0).max(1.0),
            Block::Potential(..) | Block::DivergenceFree(_) => {
                let (apart, g, h) = self.falling(z, z2);
                let beta = n2.dot(&apart);
                n2 * g - apart * (h * beta)
            }
        }
    }

    /// (S4): covariance of the potential at `z`, in scaled coordinates, and the slope along `n2` at `z2`; none if there
    /// is no potential.
    pub fn potential_slope(
        self,
        z: DVectorView<'_, f64>,
        z2: DVectorView<'_, f64>,
        n2: DVectorView<'_, f64>,
    ) -> Option<f64> {
        match self {
            Block::Linear => Some(-n2.dot(&z)),
            Block::Quadratic => Some(-n2.dot(&z) * z.dot(&z2) / (z.len() as f64 + 1.0)),
            Block::Potential(..) => {
                let (apart, g, _) = self.falling(z, z2);
                Some(-g * n2.dot(&apart))
            }
            Block::Skew | Block::DivergenceFree(_) => None,
        }
    }

    /// (S5): covariance of the potential at `z` and at `z2`; none if there is no potential.
    pub fn potential_potential(self, z: DVectorView<'_, f64>, z2: DVectorView<'_, f64>) -> Option<f64> {
        match self {
            Block::Linear => Some(z.dot(&z2)),
            Block::Quadratic => Some(z.dot(&z2).powi(2) / (2.0 * (z.len() as f64 + 1.0))),
            Block::Potential(shape, scale) => {
                let radial = Radial { shape, length: length(scale, z.len()) };
                Some(radial.potential_variance() * radial.value_at((z - z2).norm_squared()))
            }
            Block::Skew | Block::DivergenceFree(_) => None,
        }
    }

    /// z − z2, g and h of a block that falls with distance.
    fn falling(self, z: DVectorView<'_, f64>, z2: DVectorView<'_, f64>) -> (DVector<f64>, f64, f64) {
        let apart = z - z2;
        let squared = apart.norm_squared();
        let (g, h) = match self {
            Block::Potential(shape, scale) => Radial { shape, length: length(scale, z.len()) }.slopes_at(squared),
            Block::DivergenceFree(scale) => divergence_free_at(length(scale, z.len()), z.len(), squared),
            Block::Linear | Block::Quadratic | Block::Skew => (0.0, 0.0),
        };
        (apart, g, h)
    }
}

/// ℓ = s √(2n): lengths are in units of the root mean square distance of two samples.
pub(crate) fn length(scale: f64, dim: usize) -> f64 {
    scale * (2.0 * dim as f64).sqrt()
}
