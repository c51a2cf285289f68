//! Compares the velocities of demonstrations that pass the same place (R9).

use std::collections::BTreeMap;
use std::fmt;

use nalgebra::DVector;
use rand::Rng;
use rand::seq::index;
use serde::{Deserialize, Serialize};

use crate::{GpError, Rows};

/// Samples slower than this share of the root mean square speed are skipped, because near a goal all directions turn.
const SLOW: f64 = 0.5;
/// Maximum number of samples to compare.
const SAMPLES: usize = 5000;
/// Fewer pairs of trajectories than this are inconclusive.
const FEW: usize = 3;

/// Difference between the velocities of two trajectories where they pass near each other (R9). A model-free check that
/// supports a reading and never decides it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NearPasses {
    /// Number of pairs of trajectories that meet.
    pub pairs: usize,
    /// Number of pairs of samples that are near each other.
    pub samples: usize,
    /// 0: same velocities; 1: unrelated; 2: opposite. Every pair of trajectories has the same weight. `None` if no two
    /// meet.
    pub share: Option<f64>,
}

impl NearPasses {
    /// The usual distance of a near pass, in units of the root mean square distance of two samples.
    pub const USUAL_DISTANCE: f64 = 0.05;

    /// Compares samples within `distance` · √(2 Σ_k var x_k) of each other. More than 5000 samples are thinned at random.
    ///
    /// # Errors
    /// [`GpError::Parameter`] if the distance is not positive.
    pub fn of<R: Rng + ?Sized>(rows: &Rows, distance: f64, rng: &mut R) -> Result<Self, GpError> {
        if !(distance > 0.0 && distance.is_finite()) {
            return Err(GpError::Parameter {
                name: "distance",
                value: distance,
                requirement: "be positive and finite",
            });
        }
        if rows.is_empty() {
            return Ok(NearPasses { pairs: 0, samples: 0, share: None });
        }
        let squared_radius = squared_radius(rows, distance);
        let mut fast = fast(rows);
        if fast.len() > SAMPLES {
            let mut drawn = index::sample(rng, fast.len(), SAMPLES).into_vec();
            drawn.sort_unstable();
            fast = drawn.into_iter().map(|at| fast[at]).collect();
        }
        Ok(Self::among(rows, &fast, squared_radius))
    }

    fn among(rows: &Rows, fast: &[usize], squared_radius: f64) -> Self {
        // Count, Σ|u_i − u_j|² and Σ(|u_i|² + |u_j|²) for each pair of trajectories.
        let mut meetings = BTreeMap::<(usize, usize), (usize, f64, f64)>::new();
        let (x, u) = (rows.states(), rows.velocities());
        for (at, &i) in fast.iter().enumerate() {
            for &j in &fast[at + 1..] {
                let (k, l) = (rows.indices()[i].trajectory, rows.indices()[j].trajectory);
                if k == l || (x.column(i) - x.column(j)).norm_squared() > squared_radius {
                    continue;
                }
                let (count, apart, both) = meetings.entry((k.min(l), k.max(l))).or_default();
                *count += 1;
                *apart += (u.column(i) - u.column(j)).norm_squared();
                *both += u.column(i).norm_squared() + u.column(j).norm_squared();
            }
        }
        let sum =
            |part: fn(&(usize, f64, f64)) -> f64| meetings.values().map(|met| part(met) / met.0 as f64).sum::<f64>();
        NearPasses {
            pairs: meetings.len(),
            samples: meetings.values().map(|met| met.0).sum(),
            share: (!meetings.is_empty()).then(|| sum(|met| met.1) / sum(|met| met.2)),
        }
    }
}

impl fmt::Display for NearPasses {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let how = match self.share {
            Some(share) if self.pairs >= FEW && share <= 0.1 => "alike",
            Some(share) if self.pairs >= FEW && share >= 0.2 => "differently",
            Some(_) if self.pairs >= FEW => "somewhat differently",
            _ => return write!(f, "hardly any two demonstrations meet"),
        };
        write!(f, "where two of them pass the same place ({} pairs), they move {how}", self.pairs)
    }
}

/// distance² · 2 Σ_k var x_k, variances over all samples.
fn squared_radius(rows: &Rows, distance: f64) -> f64 {
    let mean: DVector<f64> = rows.states().column_mean();
    let squares: f64 = rows.states().column_iter().map(|x| (x - &mean).norm_squared()).sum();
    distance * distance * 2.0 * squares / rows.len() as f64
}

/// Samples that are not slow.
fn fast(rows: &Rows) -> Vec<usize> {
    let mean_square = rows.velocities().norm_squared() / rows.len() as f64;
    let least = SLOW * SLOW * mean_square;
    (0..rows.len()).filter(|&row| rows.velocities().column(row).norm_squared() >= least).collect()
}
