use rayon::prelude::*;

use crate::search::{Neighbour, SampleTree};
use lanes::exp_in_bulk;

/// Number of leaves of the tree whose samples form one block.
const LEAVES: usize = 512;
/// Bytes per row, and per other trajectory in it.
const PER_ROW: u64 = 8 + 4 + 4;
const PER_ENTRY: u64 = 4 + 8 + 8;

/// The responsibilities q_km (12) of samples that several trajectories share, and the potentials of their local models
/// there.
///
/// All other samples have q = 1 for their own trajectory and contribute nothing to H or a. All products with H are
/// computed from these rows, because H itself has an entry for each pair of trajectories in any of them.
#[derive(Debug)]
pub(crate) struct SharedSamples {
    /// In the order of the tree, so that neighbours are together.
    pub(crate) blocks: Vec<SparseRows>,
    pub(crate) n_trajectories: usize,
}

/// The rows of neighbouring samples, one after the other.
#[derive(Debug, Default)]
pub(crate) struct SparseRows {
    /// For each row, its own trajectory o.
    owners: Vec<u32>,
    /// For each row, q_om.
    own_shares: Vec<f64>,
    /// For each row, the end of its entries.
    ends: Vec<u32>,
    /// Other trajectories k, ascending within each row.
    models: Vec<u32>,
    /// q_km.
    shares: Vec<f64>,
    /// f_km − f_om: φ̂ of the nearest samples (10).
    differences: Vec<f64>,
}

/// One sample m of trajectory o, and the other trajectories k that share it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Row<'a> {
    pub(crate) owner: usize,
    pub(crate) own_share: f64,
    pub(crate) models: &'a [u32],
    pub(crate) shares: &'a [f64],
    pub(crate) differences: &'a [f64],
}

impl SharedSamples {
    /// w_km = exp(−min_i ‖x_m − x_ki‖² / 2σ²) (11) down to `squared_radius`, q_km = w_km / Σ_j w_jm (12), with the same
    /// bits as in the dense alignment, because sums have the same order.
    pub(crate) fn new(tree: &SampleTree, potentials: &[Vec<f64>], sigma_squared: f64, squared_radius: f64) -> Self {
        let blocks = (0..tree.n_leaves().div_ceil(LEAVES)).into_par_iter().map(|block| {
            let leaves = block * LEAVES..tree.n_leaves().min((block + 1) * LEAVES);
            let mut rows = SparseRows::default();
            let mut found = Vec::new();
            for leaf in leaves {
                tree.neighbours(leaf, squared_radius, &mut found, |place, neighbours| {
                    let own = potentials[place.trajectory as usize][place.sample as usize];
                    rows.push(place.trajectory, own, neighbours, potentials, sigma_squared);
                });
            }
            rows.shrink();
            rows
        });
        SharedSamples { blocks: blocks.collect(), n_trajectories: potentials.len() }
    }

    pub(crate) fn rows(&self) -> impl Iterator<Item = Row<'_>> {
        self.blocks.iter().flat_map(SparseRows::rows)
    }

    /// Bytes for `samples` samples, each with `others` other trajectories.
    pub(crate) fn bytes(samples: u64, others: f64) -> u64 {
        samples * PER_ROW + (samples as f64 * others * PER_ENTRY as f64) as u64
    }
}

impl SparseRows {
    fn push(&mut self, owner: u32, own: f64, others: &[Neighbour], potentials: &[Vec<f64>], sigma_squared: f64) {
        let first = self.models.len();
        let (mut total, mut counted) = (0.0, false);
        for Neighbour { place, squared_distance } in others {
            let weight = exp_in_bulk(-0.5 * (squared_distance / sigma_squared));
            if weight == 0.0 {
                continue;
            }
            if place.trajectory > owner && !counted {
                (total, counted) = (total + 1.0, true);
            }
            total += weight;
            self.models.push(place.trajectory);
            self.shares.push(weight);
            self.differences.push(potentials[place.trajectory as usize][place.sample as usize] - own);
        }
        if self.models.len() == first {
            return;
        }
        let total = if counted { total } else { total + 1.0 };
        self.shares[first..].iter_mut().for_each(|share| *share /= total);
        self.owners.push(owner);
        self.own_shares.push(1.0 / total);
        self.ends.push(self.models.len() as u32);
    }

    fn shrink(&mut self) {
        self.owners.shrink_to_fit();
        self.own_shares.shrink_to_fit();
        self.ends.shrink_to_fit();
        self.models.shrink_to_fit();
        self.shares.shrink_to_fit();
        self.differences.shrink_to_fit();
    }

    pub(crate) fn rows(&self) -> impl Iterator<Item = Row<'_>> {
        let mut first = 0;
        self.owners.iter().zip(&self.own_shares).zip(&self.ends).map(move |((&owner, &own_share), &end)| {
            let range = first..end as usize;
            first = end as usize;
            Row {
                owner: owner as usize,
                own_share,
                models: &self.models[range.clone()],
                shares: &self.shares[range.clone()],
                differences: &self.differences[range],
            }
        })
    }
}
