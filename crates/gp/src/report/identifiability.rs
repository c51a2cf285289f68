//! Determines which directions of a policy the demonstrations identify.

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

/// Mean posterior variance of the policy divided by its mean prior variance: 0 if the demonstrations determine the
/// policy, 1 if they do not.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Identifiability {
    /// Along each axis.
    pub axes: Vec<f64>,
    /// Along `direction`.
    pub least: f64,
    /// The least known direction, (n).
    pub direction: Vec<f64>,
}

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

    /// n times the share: 1 if movements go in all directions alike, 0 if none goes along this one.
    pub fn coverage(&self) -> f64 {
        self.share * self.direction.len() as f64
    }
}

impl Identifiability {
    /// From the mean posterior and prior covariances of the policy, (n, n).
    pub(crate) fn of(posterior: &DMatrix<f64>, prior: &DMatrix<f64>) -> Self {
        let eigen = posterior.clone().symmetric_eigen();
        let direction = eigen.eigenvectors.column(eigen.eigenvalues.imax());
        Identifiability {
            axes: (0..prior.nrows()).map(|axis| posterior[(axis, axis)] / prior[(axis, axis)]).collect(),
            least: direction.dot(&(posterior * direction)) / direction.dot(&(prior * direction)),
            direction: direction.iter().copied().collect(),
        }
    }

    /// Whether one direction is much less known than the others.
    pub fn warns(&self) -> bool {
        let best = self.axes.iter().copied().fold(f64::INFINITY, f64::min);
        self.least > 0.1 && self.least > 10.0 * best
    }
}

impl LeastSeen {
    /// From directions of motion n, (n, M).
    pub(crate) fn of(directions: &DMatrix<f64>) -> Self {
        let mean = directions * directions.transpose() / directions.ncols() as f64;
        let eigen = mean.symmetric_eigen();
        let least = eigen.eigenvalues.imin();
        LeastSeen {
            share: eigen.eigenvalues[least].max(0.0),
            direction: eigen.eigenvectors.column(least).iter().copied().collect(),
        }
    }
}
