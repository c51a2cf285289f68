use lanes::LANES;
use motion::Demonstrations;
use nalgebra::DMatrix;
use pulp::Arch;
use rayon::prelude::*;

use super::closest::closest;
use super::nearest::NearestSamples;
use super::tiles::Tiles;
use crate::AlignError;

/// Bytes for each sample and each trajectory that may be within the radius: squared distance and index of the nearest
/// sample, responsibility and potential difference.
const PER_SAMPLE_AND_TRAJECTORY: u64 = 8 + 4 + 8 + 8;

/// Bytes for each pair of trajectories: H in parts, its eigenvectors and its elimination.
const PER_PAIR: u64 = 8 * 14;

/// All trajectories, prepared for the search for nearest samples.
#[derive(Debug)]
pub(crate) struct SearchSpace {
    trajectories: Vec<Tiles>,
}

impl SearchSpace {
    pub(crate) fn new(demonstrations: &Demonstrations) -> Self {
        let arch = Arch::new();
        let tiles = demonstrations.trajectories().iter().map(|t| Tiles::new(t.states(), arch));
        SearchSpace { trajectories: tiles.collect() }
    }

    /// Number K of trajectories.
    pub(crate) fn n_trajectories(&self) -> usize {
        self.trajectories.len()
    }

    /// d_kj = min_{n,m} ‖x_kn − x_jm‖² (18), shape (K, K), zero on the diagonal.
    pub(crate) fn distances(&self) -> DMatrix<f64> {
        let count = self.n_trajectories();
        let to_later = |k: usize| -> Vec<f64> {
            let later = self.trajectories[k + 1..].iter();
            later.map(|other| closest(&self.trajectories[k], other, f64::INFINITY)).collect()
        };
        let to_later: Vec<Vec<f64>> = (0..count).into_par_iter().map(to_later).collect();
        DMatrix::from_fn(count, count, |j, k| if j == k { 0.0 } else { to_later[k.min(j)][k.max(j) - k.min(j) - 1] })
    }

    /// d_k^min = min_{j≠k} d_kj (19), (K): infinite for a single trajectory.
    pub(crate) fn distances_to_nearest(&self) -> Vec<f64> {
        (0..self.n_trajectories()).into_par_iter().map(|k| self.distance_to_nearest(k)).collect()
    }

    /// Examines the trajectory with the nearest box first; its distance limits which others need a search.
    fn distance_to_nearest(&self, k: usize) -> f64 {
        let own = &self.trajectories[k];
        let others = || (0..self.n_trajectories()).filter(move |&j| j != k);
        let gaps: Vec<f64> = self.trajectories.iter().map(|other| own.boxes.squared_gap_of_all(&other.boxes)).collect();
        let Some(first) = others().min_by(|&i, &j| gaps[i].total_cmp(&gaps[j])) else { return f64::INFINITY };
        let found = closest(own, &self.trajectories[first], f64::INFINITY);
        let nearer = |found, j| if gaps[j] < found { closest(own, &self.trajectories[j], found) } else { found };
        others().filter(|&j| j != first).fold(found, nearer)
    }

    /// The nearest samples for all pairs of trajectories, up to a squared distance of `squared_radius`.
    ///
    /// # Errors
    /// [`AlignError::Memory`] if they and the data derived from them could take more than `memory_limit` bytes.
    pub(crate) fn nearest(&self, squared_radius: f64, memory_limit: u64) -> Result<NearestSamples, AlignError> {
        let neighbours = self.neighbours(squared_radius);
        let needed = self.bytes(&neighbours);
        if needed > memory_limit {
            return Err(AlignError::Memory { needed, limit: memory_limit });
        }
        Ok(NearestSamples::search(&self.trajectories, neighbours, squared_radius))
    }

    /// Upper bound on the memory of the alignment with these neighbours.
    fn bytes(&self, neighbours: &[Vec<usize>]) -> u64 {
        let samples = |k: usize| self.trajectories[k].n_samples.next_multiple_of(LANES) as u64;
        let pairs = neighbours.iter().enumerate().flat_map(|(i, later)| later.iter().map(move |&j| (i, j)));
        let linked: u64 = pairs.map(|(i, j)| samples(i) + samples(j)).sum();
        PER_SAMPLE_AND_TRAJECTORY * linked + PER_PAIR * (neighbours.len() as u64).pow(2)
    }

    /// For each trajectory i, those of i, i + 1, … whose boxes are within the search radius of its own, ascending.
    fn neighbours(&self, squared_radius: f64) -> Vec<Vec<usize>> {
        let neighbours_of = |i: usize| -> Vec<usize> {
            let own = &self.trajectories[i].boxes;
            let within = |&j: &usize| own.is_within(squared_radius, &self.trajectories[j].boxes);
            (i..self.n_trajectories()).filter(within).collect()
        };
        (0..self.n_trajectories()).into_par_iter().map(neighbours_of).collect()
    }
}
