use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use crate::AlignError;
use crate::search::{SampleTree, SearchSpace};

/// The rule for the bandwidth σ² in (11), from the squared distances d_kj = min over samples ‖x_kn − x_jm‖² of
/// trajectories (18).
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Bandwidth {
    /// σ² = median_k min_{j≠k} d_kj (19), (20): the usual distance to the nearest other trajectory.
    #[default]
    Narrow,
    /// The geometric mean of the other two, σ² = √(σ²_nar σ²_wid) (22).
    Medium,
    /// σ² = median_{j≠k} d_jk (21): the usual distance between two trajectories.
    Wide,
    /// A given σ², in units of the state squared.
    Fixed(f64),
}

impl Bandwidth {
    /// σ² from the squared distances (K, K) between trajectories; the diagonal is not read.
    ///
    /// # Errors
    /// [`AlignError::SingleTrajectory`], [`AlignError::ZeroBandwidth`] or, for `Fixed`, [`AlignError::Parameter`].
    pub fn sigma_squared(self, distances: &DMatrix<f64>) -> Result<f64, AlignError> {
        self.check()?;
        if let Bandwidth::Fixed(sigma_squared) = self {
            return Ok(sigma_squared);
        }
        if distances.ncols() < 2 {
            return Err(AlignError::SingleTrajectory);
        }
        let sigma_squared = self.rule(distances);
        if sigma_squared > 0.0 {
            return Ok(sigma_squared);
        }
        // Applies the rule to the other pairs, as if those that touch did not meet.
        let apart = distances.map(|distance| if distance > 0.0 { distance } else { f64::INFINITY });
        let usable = Some(self.rule(&apart)).filter(|usable| usable.is_finite());
        Err(AlignError::ZeroBandwidth { pairs: touching(distances), usable })
    }

    fn rule(self, distances: &DMatrix<f64>) -> f64 {
        match self {
            Bandwidth::Narrow => narrow(distances),
            Bandwidth::Wide => wide(distances),
            // Two roots, so that the product can neither overflow nor underflow.
            _ => narrow(distances).sqrt() * wide(distances).sqrt(),
        }
    }

    /// σ² among trajectories. Narrow bandwidths only need the distance of each trajectory to its nearest.
    pub(crate) fn among(self, space: &SearchSpace) -> Result<f64, AlignError> {
        self.check()?;
        match self {
            Bandwidth::Fixed(sigma_squared) => return Ok(sigma_squared),
            Bandwidth::Narrow if space.n_trajectories() > 1 => {
                let sigma_squared = median(space.distances_to_nearest());
                if sigma_squared > 0.0 {
                    return Ok(sigma_squared);
                }
            }
            _ => {}
        }
        self.sigma_squared(&space.distances())
    }

    /// Whether σ² depends on the distances of all pairs of trajectories.
    pub(crate) fn needs_all_pairs(self) -> bool {
        !matches!(self, Bandwidth::Narrow | Bandwidth::Fixed(_))
    }

    /// σ² among many trajectories, for rules that do not need the distances of all pairs.
    pub(crate) fn among_many(self, n_trajectories: usize, tree: &SampleTree) -> Result<f64, AlignError> {
        if let Bandwidth::Fixed(sigma_squared) = self {
            return Ok(sigma_squared);
        }
        if n_trajectories < 2 {
            return Err(AlignError::SingleTrajectory);
        }
        let sigma_squared = median(tree.distances_to_nearest(n_trajectories, &[]));
        if sigma_squared > 0.0 {
            return Ok(sigma_squared);
        }
        // As if those that touch did not meet.
        let pairs = tree.touching();
        let usable = Some(median(tree.distances_to_nearest(n_trajectories, &pairs)));
        Err(AlignError::ZeroBandwidth { pairs, usable: usable.filter(|usable| usable.is_finite()) })
    }

    pub(crate) fn check(self) -> Result<(), AlignError> {
        match self {
            Bandwidth::Fixed(value) if !(value.is_finite() && value > 0.0) => Err(AlignError::Parameter {
                name: "bandwidth Fixed(sigma_squared)",
                value,
                requirement: "be positive and finite",
            }),
            _ => Ok(()),
        }
    }
}

fn narrow(distances: &DMatrix<f64>) -> f64 {
    let nearest = distances.column_iter().enumerate().map(|(k, column)| {
        let others = column.iter().enumerate().filter(|&(j, _)| j != k);
        others.map(|(_, &distance)| distance).fold(f64::INFINITY, f64::min)
    });
    median(nearest)
}

/// Each pair is used once: d is symmetric, and a list and its duplicate have the same median.
fn wide(distances: &DMatrix<f64>) -> f64 {
    median(pairs(distances).map(|(_, _, distance)| distance))
}

fn touching(distances: &DMatrix<f64>) -> Vec<(usize, usize)> {
    pairs(distances).filter(|&(.., distance)| distance == 0.0).map(|(k, j, _)| (k, j)).collect()
}

/// (k, j, d_kj) for all k < j, in order of k.
fn pairs(distances: &DMatrix<f64>) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
    let count = distances.ncols();
    (0..count).flat_map(move |k| (k + 1..count).map(move |j| (k, j, distances[(j, k)])))
}

/// The median of the finite values; infinite if there are none.
fn median(values: impl IntoIterator<Item = f64>) -> f64 {
    motion::median(values.into_iter().filter(|value| value.is_finite()).collect()).unwrap_or(f64::INFINITY)
}
