//! Determines which directions of a policy the demonstrations identify.

use motion::LeastSeen;
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

/// The direction with the least motion among directions of motion n, (n, M).
pub(crate) fn least_seen(directions: &DMatrix<f64>) -> LeastSeen {
    LeastSeen::of_mean(directions * directions.transpose() / directions.ncols() as f64)
}
