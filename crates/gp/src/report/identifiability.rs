//! Which directions of a policy the demonstrations determine.

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

/// Mean posterior over mean prior variance of the policy: 0 where the demonstrations determine it, 1 where they do not.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Identifiability {
    /// Along every axis.
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
    /// Least eigenvalue of the mean of n nᵀ: 0 if nothing ever moved there, 1/n if all directions are seen alike.
    pub share: f64,
    /// Its direction, (n).
    pub direction: Vec<f64>,
}

impl Identifiability {
    /// Of mean posterior and prior covariances of the policy, (n, n).
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
    /// Of directions of motion n, (n, M).
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

/// A direction in words.
pub(crate) fn direction(vector: &[f64]) -> String {
    let entries: Vec<_> = vector.iter().map(|entry| format!("{entry:.2}")).collect();
    format!("({})", entries.join(", "))
}
