use motion::{Demonstrations, SampleIndex};
use nalgebra::{DVector, DVectorView};

use crate::offsets::bipartition::Partition;
use crate::{AlignmentObjective, LocalPotential, Split, Warning};

/// Aligned local potentials, the result of [`PolicyAlign::align`](crate::PolicyAlign::align).
#[derive(Debug, Clone, PartialEq)]
pub struct Aligned {
    pub(crate) demonstrations: Demonstrations,
    pub(crate) potentials: Vec<Vec<f64>>,
    pub(crate) sigma_squared: f64,
    pub(crate) objective: Option<AlignmentObjective>,
    pub(crate) partition: Partition,
    /// All of `partition` except the first group, ascending.
    pub(crate) discarded: Vec<usize>,
    pub(crate) offsets: DVector<f64>,
    pub(crate) warnings: Vec<Warning>,
}

impl Aligned {
    /// The aligned trajectories, ascending: the largest group whose offsets the data determine.
    pub fn kept(&self) -> &[usize] {
        &self.partition.groups[0]
    }

    /// All other trajectories, ascending.
    pub fn discarded(&self) -> &[usize] {
        &self.discarded
    }

    /// All groups, each ascending: the largest (kept) first, then by size; groups of equal size are ordered by their
    /// lowest trajectory.
    pub fn groups(&self) -> &[Vec<usize>] {
        &self.partition.groups
    }

    /// The history of the groups, step by step: first the split of all trajectories, then those of its parts; a group
    /// always comes before its parts. Parts that are not split further are the [`Aligned::groups`]. Empty if there was
    /// no split.
    pub fn splits(&self) -> &[Split] {
        &self.partition.splits
    }

    /// Offsets b (17), one for each of [`Aligned::kept`] in that order, in units of the potential; their sum is 0.
    pub fn offsets(&self) -> &DVector<f64> {
        &self.offsets
    }

    /// The offset of one trajectory; `None` if it was discarded.
    pub fn offset(&self, trajectory: usize) -> Option<f64> {
        self.kept().binary_search(&trajectory).ok().map(|at| self.offsets[at])
    }

    /// The bandwidth σ² (18)–(22), in units of the state squared.
    pub fn sigma_squared(&self) -> f64 {
        self.sigma_squared
    }

    /// The second smallest eigenvalue of H among the kept trajectories, which measures how strongly their weakest part
    /// is connected. `None` if a single trajectory was kept.
    pub fn lambda_2(&self) -> Option<f64> {
        self.partition.lambda_2
    }

    /// Reasons to doubt the result.
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }

    /// The objective of all trajectories, kept and discarded; `None` if H was not formed, because there are many
    /// trajectories and each meets few others.
    pub fn objective(&self) -> Option<&AlignmentObjective> {
        self.objective.as_ref()
    }

    /// The demonstrations that were aligned.
    pub fn demonstrations(&self) -> &Demonstrations {
        &self.demonstrations
    }

    /// The local potential of each trajectory, without its offset.
    pub fn local_potentials(&self) -> impl ExactSizeIterator<Item = LocalPotential<'_>> {
        let trajectories = self.demonstrations.trajectories().iter();
        trajectories.zip(&self.potentials).map(|(trajectory, values)| LocalPotential::new(trajectory, values))
    }

    /// Responsibility of each local model for a state: q(x) (12), (K).
    ///
    /// Trajectories at equal distances have equal shares. If squared distances to a state overflow, the trajectories for
    /// which they do count as equally near. A state with a NaN has NaN shares.
    ///
    /// # Panics
    /// If the dimension of the state differs from that of the trajectories.
    pub fn responsibilities(&self, state: DVectorView<'_, f64>) -> DVector<f64> {
        let distances: Vec<f64> = self.local_potentials().map(|local| local.nearest(state).1).collect();
        let nearest = distances.iter().copied().fold(f64::INFINITY, f64::min);
        // If the nearest distance is infinite, the excess would be NaN.
        let excess = |distance: f64| if distance == nearest { 0.0 } else { distance - nearest };
        let weight = |distance| (-0.5 * (excess(distance) / self.sigma_squared)).exp();
        let weights = DVector::from_iterator(distances.len(), distances.into_iter().map(weight));
        &weights / weights.sum()
    }

    /// State and aligned potential of one sample of a kept trajectory.
    pub(crate) fn sample(&self, index: SampleIndex) -> (DVectorView<'_, f64>, f64) {
        let offset = self.offset(index.trajectory).expect("samples are of kept trajectories");
        let state = self.demonstrations.trajectories()[index.trajectory].state(index.sample);
        (state, self.potentials[index.trajectory][index.sample] + offset)
    }
}
