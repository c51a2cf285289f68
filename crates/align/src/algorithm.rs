use motion::Demonstrations;
use nalgebra::DVector;
use serde::{Deserialize, Serialize};

use crate::checks::{check, one_context};
use crate::offsets::bipartition::{Partition, bipartition};
use crate::offsets::group_offsets::group_offsets;
use crate::offsets::responsibilities::{Responsibilities, squared_radius};
use crate::search::{NearestSamples, SampleTree, SearchSpace, check_span};
use crate::sparse::{self, SharedSamples};
use crate::{AlignError, Aligned, AlignmentObjective, Bandwidth, Integration, Warning};

/// From this number of trajectories on, they are aligned without the matrix H if they have few neighbours.
const MANY: usize = 256;
/// A sample is near few trajectories if they are less than this share of all.
const FEW: f64 = 0.1;
/// Number of leaves of the tree of samples used to estimate how many trajectories are near a sample.
const PROBED: usize = 64;

/// Whether this number of trajectories, with this number of them near a sample, is aligned without H.
type Choice<'a> = &'a (dyn Fn(usize, f64) -> bool + Sync);

/// Results of steps 3 to 5.
struct Levels {
    sigma_squared: f64,
    objective: Option<AlignmentObjective>,
    partition: Partition,
    offsets: DVector<f64>,
}

/// Algorithm 1 of the paper up to the regression: shifts the potentials along single trajectories to a common level.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PolicyAlign {
    /// The integration rule for the potential along each trajectory.
    pub integration: Integration,
    /// The bandwidth of the responsibilities.
    pub bandwidth: Bandwidth,
    /// Groups of trajectories are split if an eigenvalue of H, other than that of the constant vector, is below this threshold. In units of
    /// H, which grows with the number of samples. Positive; 1e-8 by default.
    pub eigenvalue_threshold: f64,
    /// Responsibilities below this share of the largest at a sample are dropped; in [0, 1), 1e-20 by default, with which offsets keep 14
    /// digits.
    pub responsibility_floor: f64,
    /// Maximum memory of the alignment in bytes; 8 GiB by default. A larger alignment is refused before the search.
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
    /// Aligns the local potentials of all trajectories, and discards those whose level the data do not determine.
    ///
    /// Time and memory grow with the number of pairs of samples within the bandwidth's search radius: with K trajectories of N samples, up
    /// to 28 bytes for each of K²N, and K³ operations on H. From 256 trajectories with few neighbours on, H is not formed: M samples then
    /// take O(M log M) time, and some 36 bytes each in addition to the states. Coordinates are compared without wrapping, so unwrap
    /// continuous angles beforehand.
    ///
    /// # Errors
    /// [`AlignError`] for parameters out of range, missing velocities, an undefined bandwidth, overflow, underflow or too many samples for
    /// the memory.
    pub fn align(&self, demonstrations: &Demonstrations) -> Result<Aligned, AlignError> {
        self.align_with(&|count, neighbours| count >= MANY && neighbours <= FEW * count as f64, demonstrations)
    }

    /// As [`align`](Self::align); `sparse` decides, from the number of trajectories and of those near a sample, whether to avoid H.
    fn align_with(&self, sparse: Choice<'_>, demonstrations: &Demonstrations) -> Result<Aligned, AlignError> {
        // Enters the thread pool once for all steps.
        rayon::scope(|_| {
            self.check()?;
            let potentials = self.integration.potentials(demonstrations)?;
            check_span(demonstrations)?;
            one_context(demonstrations)?;
            let levels = match self.few_neighbours(sparse, demonstrations)? {
                Some((tree, sigma_squared)) => self.level_sparse(tree, &potentials, sigma_squared)?,
                None => self.level(&SearchSpace::new(demonstrations), &potentials)?,
            };
            let Levels { sigma_squared, objective, partition, offsets } = levels;
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

    /// Steps 3 to 5 with H as a matrix.
    fn level(&self, space: &SearchSpace, potentials: &[Vec<f64>]) -> Result<Levels, AlignError> {
        let (sigma_squared, nearest) = self.search(space)?;
        let responsibilities = Responsibilities::new(&nearest, potentials, sigma_squared);
        let objective = AlignmentObjective::new(&responsibilities);
        let masses = vec![1.0; potentials.len()];
        let partition = bipartition(&objective.laplacian, &masses, self.eigenvalue_threshold)?;
        let offsets = group_offsets(&responsibilities, &objective, &partition.groups[0])?;
        Ok(Levels { sigma_squared, objective: Some(objective), partition, offsets })
    }

    /// The same without H, which has as many entries as there are pairs of trajectories that meet.
    fn level_sparse(
        &self,
        tree: SampleTree,
        potentials: &[Vec<f64>],
        sigma_squared: f64,
    ) -> Result<Levels, AlignError> {
        let squared_radius = squared_radius(sigma_squared, self.responsibility_floor);
        let samples = SharedSamples::new(&tree, potentials, sigma_squared, squared_radius);
        drop(tree);
        let (partition, preconditioner) = sparse::partition(&samples, self.eigenvalue_threshold)?;
        let offsets = sparse::offsets(&samples, &partition.groups[0], preconditioner)?;
        Ok(Levels { sigma_squared, objective: None, partition, offsets })
    }

    /// The bandwidth, if there are many trajectories and each sample is near few of them.
    fn few_neighbours(
        &self,
        sparse: Choice<'_>,
        demonstrations: &Demonstrations,
    ) -> Result<Option<(SampleTree, f64)>, AlignError> {
        let (count, samples) = (demonstrations.n_trajectories(), demonstrations.n_samples());
        if !sparse(count, 0.0)
            || self.bandwidth.needs_all_pairs()
            || self.responsibility_floor == 0.0
            || samples > u32::MAX as usize
        {
            return Ok(None);
        }
        let tree = SampleTree::new(demonstrations);
        let sigma_squared = self.bandwidth.among_many(count, &tree)?;
        let squared_radius = squared_radius(sigma_squared, self.responsibility_floor);
        let neighbours = tree.mean_neighbours(PROBED, squared_radius);
        if !sparse(count, neighbours) {
            return Ok(None);
        }
        let needed = tree.bytes() + SharedSamples::bytes(samples as u64, neighbours);
        if needed > self.memory_limit {
            return Err(AlignError::Memory { needed, limit: self.memory_limit });
        }
        Ok(Some((tree, sigma_squared)))
    }

    /// The bandwidth, and the nearest samples within its search radius.
    fn search(&self, space: &SearchSpace) -> Result<(f64, NearestSamples), AlignError> {
        let squared_radius = |sigma_squared| squared_radius(sigma_squared, self.responsibility_floor);
        if self.bandwidth == Bandwidth::Wide {
            // Nearly everything is within the search radius, which then gives all distances between trajectories.
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

#[cfg(test)]
mod tests;
