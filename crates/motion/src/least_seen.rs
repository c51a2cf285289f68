use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

/// The direction with the least motion, independent of any model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LeastSeen {
    /// Smallest eigenvalue of the mean of n nᵀ: 0 if nothing ever moved along its eigenvector, 1/n if all directions
    /// were observed equally.
    pub share: f64,
    /// The eigenvector, (n).
    pub direction: Vec<f64>,
}

impl LeastSeen {
    /// Coverage below which no movement tested the policy along the direction.
    pub const COVERED: f64 = 0.1;

    /// From the mean of n nᵀ over directions of motion n, (n, n).
    pub fn of_mean(mean: DMatrix<f64>) -> Self {
        let eigen = mean.symmetric_eigen();
        let least = eigen.eigenvalues.imin();
        LeastSeen {
            share: eigen.eigenvalues[least].max(0.0),
            direction: eigen.eigenvectors.column(least).iter().copied().collect(),
        }
    }

    /// n times the share: 1 if movements go in all directions alike, 0 if none goes along this one.
    pub fn coverage(&self) -> f64 {
        self.share * self.direction.len() as f64
    }
}
