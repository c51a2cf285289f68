use nalgebra::{DVector, DVectorView};
use serde::{Deserialize, Serialize};

use crate::kernel::shape::{Radial, Shape, divergence_free_at};

/// One term of the slope GP's prior: a covariance of slopes nᵀπ, and of the potential.
///
/// Distances are in scaled coordinates z of state and context, (n + p). Directions, (n), concern the state only, because contexts
/// do not move. A scale s stands for the length ℓ = s √(2(n + p)).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Block {
    /// Potentials linear in the state: constant policies.
    Linear,
    /// Quadratic potentials.
    Quadratic,
    /// Potentials of this shape and scale.
    Potential(Shape, f64),
    /// Policies Sz with skew-symmetric S: rotation without a potential. Not in one dimension.
    Skew,
    /// Divergence-free policies at this scale, squared exponential. Not in one dimension.
    DivergenceFree(f64),
}

impl Block {
    /// Whether policies drawn from this block have a potential.
    pub fn has_potential(self) -> bool {
        !matches!(self, Block::Skew | Block::DivergenceFree(_))
    }

    /// (S3): covariance of the slopes along `n` at `z` and along `n2` at `z2`; scaled states with their context, (n + p), and unit
    /// directions, (n).
    pub fn slope_slope(
        self,
        z: DVectorView<'_, f64>,
        n: DVectorView<'_, f64>,
        z2: DVectorView<'_, f64>,
        n2: DVectorView<'_, f64>,
    ) -> f64 {
        let nu = n.dot(&n2);
        let (x, x2) = (z.rows(0, n.len()), z2.rows(0, n.len()));
        let along = || n.dot(&x2) * n2.dot(&x);
        match self {
            Block::Linear => nu,
            Block::Quadratic => (nu * z.dot(&z2) + along()) / (z.len() as f64 + 1.0),
            Block::Skew => (nu * x.dot(&x2) - along()) / (n.len() as f64 - 1.0).max(1.0),
            Block::Potential(..) | Block::DivergenceFree(_) => {
                let (apart, g, h) = self.falling(z, z2, n.len());
                g * nu - h * n.dot(&apart) * n2.dot(&apart)
            }
        }
    }

    /// Covariance of the policy at `z` with the slope along `n2` at `z2`: (S3) with each unit vector in turn as `n`, (n); shapes
    /// as in [`Block::slope_slope`].
    pub fn policy_slope(
        self,
        z: DVectorView<'_, f64>,
        z2: DVectorView<'_, f64>,
        n2: DVectorView<'_, f64>,
    ) -> DVector<f64> {
        let (x, x2) = (z.rows(0, n2.len()), z2.rows(0, n2.len()));
        match self {
            Block::Linear => n2.clone_owned(),
            Block::Quadratic => (n2 * z.dot(&z2) + x2 * n2.dot(&x)) / (z.len() as f64 + 1.0),
            Block::Skew => (n2 * x.dot(&x2) - x2 * n2.dot(&x)) / (n2.len() as f64 - 1.0).max(1.0),
            Block::Potential(..) | Block::DivergenceFree(_) => {
                let (apart, g, h) = self.falling(z, z2, n2.len());
                let beta = n2.dot(&apart);
                n2 * g - apart * (h * beta)
            }
        }
    }

    /// (S4): covariance of the potential at `z`, in scaled coordinates, with the slope along `n2` at `z2`; `None` without a
    /// potential. Shapes as in [`Block::slope_slope`].
    pub fn potential_slope(
        self,
        z: DVectorView<'_, f64>,
        z2: DVectorView<'_, f64>,
        n2: DVectorView<'_, f64>,
    ) -> Option<f64> {
        let along = || n2.dot(&z.rows(0, n2.len()));
        match self {
            Block::Linear => Some(-along()),
            Block::Quadratic => Some(-along() * z.dot(&z2) / (z.len() as f64 + 1.0)),
            Block::Potential(..) => {
                let (apart, g, _) = self.falling(z, z2, n2.len());
                Some(-g * n2.dot(&apart))
            }
            Block::Skew | Block::DivergenceFree(_) => None,
        }
    }

    /// (S5): covariance of the potential at `z` with that at `z2`, (n + p) each, in scaled coordinates; `None` without a
    /// potential.
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

    /// x − x2, (n), g and h of a block that decays with distance.
    fn falling(self, z: DVectorView<'_, f64>, z2: DVectorView<'_, f64>, dim: usize) -> (DVector<f64>, f64, f64) {
        let squared = (z - z2).norm_squared();
        let apart = z.rows(0, dim) - z2.rows(0, dim);
        let (g, h) = match self {
            Block::Potential(shape, scale) => Radial { shape, length: length(scale, z.len()) }.slopes_at(squared),
            Block::DivergenceFree(scale) => {
                divergence_free_at((length(scale, z.len()), dim), squared, apart.norm_squared())
            }
            Block::Linear | Block::Quadratic | Block::Skew => (0.0, 0.0),
        };
        (apart, g, h)
    }
}

/// ℓ = s √(2n): lengths are in units of the root mean square distance of two samples.
pub(crate) fn length(scale: f64, dim: usize) -> f64 {
    scale * (2.0 * dim as f64).sqrt()
}
