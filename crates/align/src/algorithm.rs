use motion::Demonstrations;

use crate::bipartition::bipartition;
use crate::nearest::NearestSamples;
use crate::offsets::group_offsets;
use crate::responsibilities::Responsibilities;
use crate::{AlignError, Aligned, AlignmentObjective, Bandwidth, Integration};

/// Algorithm 1 of the paper, up to the regression: brings the potentials along single trajectories to one level.
#[derive(Debug, Clone, PartialEq)]
pub struct PolicyAlign {
    /// How the potential along each trajectory is found.
    pub integration: Integration,
    /// How far each local model speaks beyond its trajectory.
    pub bandwidth: Bandwidth,
    /// Groups of trajectories are taken apart if an eigenvalue of H, beside the one of the constant vector, is below
    /// this; in units of H, which grows with the number of samples. Positive; 1e-8 by default.
    pub eigenvalue_threshold: f64,
    /// Responsibilities below this share of the largest at a sample are dropped; in [0, 1), 1e-20 by default, at which
    /// offsets keep 14 digits.
    pub responsibility_floor: f64,
}

impl Default for PolicyAlign {
    fn default() -> Self {
        PolicyAlign {
            integration: Integration::default(),
            bandwidth: Bandwidth::default(),
            eigenvalue_threshold: 1e-8,
            responsibility_floor: 1e-20,
        }
    }
}

impl PolicyAlign {
    /// Aligns the local potentials of all trajectories, and leaves out those whose level the data do not determine.
    ///
    /// Work and memory grow with the square of the number of samples. Coordinates are compared as they are: unwrap
    /// continuous angles beforehand.
    ///
    /// # Errors
    /// [`AlignError`] for parameters out of range, missing velocities, an undefined bandwidth or overflow.
    pub fn align(&self, demonstrations: &Demonstrations) -> Result<Aligned, AlignError> {
        // One visit to the thread pool for all steps.
        rayon::scope(|_| {
            self.check()?;
            let potentials = self.integration.potentials(demonstrations)?;
            let nearest = NearestSamples::search(demonstrations)?;
            let sigma_squared = self.bandwidth.sigma_squared(&nearest.trajectory_distances())?;
            let responsibilities =
                Responsibilities::new(&nearest, &potentials, sigma_squared, self.responsibility_floor);
            let objective = AlignmentObjective::new(&responsibilities);
            let partition = bipartition(&objective.laplacian, self.eigenvalue_threshold)?;
            let offsets = group_offsets(&responsibilities, &objective, &partition.groups[0])?;
            Ok(Aligned::new(self, demonstrations, potentials, sigma_squared, objective, partition, offsets))
        })
    }

    fn check(&self) -> Result<(), AlignError> {
        self.bandwidth.check()?;
        let threshold = self.eigenvalue_threshold;
        if !(threshold.is_finite() && threshold > 0.0) {
            let requirement = "be positive and finite";
            return Err(AlignError::Parameter { name: "eigenvalue_threshold", value: threshold, requirement });
        }
        let floor = self.responsibility_floor;
        if !(0.0..1.0).contains(&floor) {
            let requirement = "be at least 0 and less than 1";
            return Err(AlignError::Parameter { name: "responsibility_floor", value: floor, requirement });
        }
        Ok(())
    }
}
