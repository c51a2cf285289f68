use motion::Demonstrations;
use serde::{Deserialize, Serialize};

use crate::checks::check;
use crate::offsets::bipartition::bipartition;
use crate::offsets::group_offsets::group_offsets;
use crate::offsets::responsibilities::{Responsibilities, squared_radius};
use crate::search::{NearestSamples, SearchSpace};
use crate::{AlignError, Aligned, AlignmentObjective, Bandwidth, Integration, Warning};

/// Algorithm 1 of the paper, up to the regression: brings the potentials along single trajectories to one level.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PolicyAlign {
    /// The integration rule for the potential along each trajectory.
    pub integration: Integration,
    /// The bandwidth of the responsibilities.
    pub bandwidth: Bandwidth,
    /// Groups of trajectories are split if an eigenvalue of H, beside the one of the constant vector, is below
    /// this; in units of H, which grows with the number of samples. Positive; 1e-8 by default.
    pub eigenvalue_threshold: f64,
    /// Responsibilities below this share of the largest at a sample are dropped; in [0, 1), 1e-20 by default, at which
    /// offsets keep 14 digits.
    pub responsibility_floor: f64,
    /// Bytes of memory that the alignment may take; 8 GiB by default. A larger alignment is refused before the search.
    pub memory_limit: u64,
}

impl Default for PolicyAlign {
    fn default() -> Self {
        PolicyAlign {
            integration: Integration::default(),
            bandwidth: Bandwidth::default(),
            eigenvalue_threshold: 1e-8,
            responsibility_floor: 1e-20,
            memory_limit: 8 << 30,
        }
    }
}

impl PolicyAlign {
    /// Aligns the local potentials of all trajectories, and leaves out those whose level the data do not determine.
    ///
    /// Time and memory grow with the number of pairs of samples within the bandwidth's search radius: with K
    /// trajectories of N samples, up to 28 bytes for each of K²N. Coordinates are compared as they are: unwrap continuous
    /// angles beforehand.
    ///
    /// # Errors
    /// [`AlignError`] for parameters out of range, missing velocities, an undefined bandwidth, overflow, underflow or
    /// too many samples for the memory.
    pub fn align(&self, demonstrations: &Demonstrations) -> Result<Aligned, AlignError> {
        // One visit to the thread pool for all steps.
        rayon::scope(|_| {
            self.check()?;
            let potentials = self.integration.potentials(demonstrations)?;
            let space = SearchSpace::new(demonstrations)?;
            let (sigma_squared, nearest) = self.search(&space)?;
            let responsibilities = Responsibilities::new(&nearest, &potentials, sigma_squared);
            let objective = AlignmentObjective::new(&responsibilities);
            let partition = bipartition(&objective.laplacian, self.eigenvalue_threshold)?;
            let offsets = group_offsets(&responsibilities, &objective, &partition.groups[0])?;
            let mut warnings = Warning::about(&partition, self.eigenvalue_threshold);
            warnings.extend(check(demonstrations));
            let mut discarded = partition.groups[1..].concat();
            discarded.sort_unstable();
            let demonstrations = demonstrations.clone();
            Ok(Aligned {
                demonstrations,
                potentials,
                sigma_squared,
                objective,
                partition,
                discarded,
                offsets,
                warnings,
            })
        })
    }

    /// The bandwidth, and the nearest samples within its search radius.
    fn search(&self, space: &SearchSpace) -> Result<(f64, NearestSamples), AlignError> {
        let squared_radius = |sigma_squared| squared_radius(sigma_squared, self.responsibility_floor);
        if self.bandwidth == Bandwidth::Wide {
            // Nearly everything will be within the search radius, and shows all distances between trajectories.
            let nearest = space.nearest(f64::INFINITY, self.memory_limit)?;
            let sigma_squared = self.bandwidth.sigma_squared(&nearest.distances())?;
            return Ok((sigma_squared, nearest.within(squared_radius(sigma_squared))));
        }
        let sigma_squared = self.bandwidth.among(space)?;
        Ok((sigma_squared, space.nearest(squared_radius(sigma_squared), self.memory_limit)?))
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
