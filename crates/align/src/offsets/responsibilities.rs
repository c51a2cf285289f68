#![allow(clippy::inline_always, reason = "vector instructions reach only what is inlined")]

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::weights::to_weights;
use crate::search::nearest::{Nearest, NearestSamples};
use lanes::{LANES, Lanes, groups_of};

/// The responsibilities q_km (12) of the local models for all samples, and these models' potentials there.
///
/// One block holds the samples of one trajectory. Most models are far from it and not contained in it.
#[derive(Debug)]
pub(crate) struct Responsibilities {
    pub(crate) blocks: Vec<Block>,
}

/// The samples of one trajectory, with the local models near them.
#[derive(Debug)]
pub(crate) struct Block {
    /// The models whose responsibility exceeds the floor at some sample, ascending.
    pub(crate) models: Vec<usize>,
    /// For each model in turn, q_km at every sample, padded with 0.
    pub(crate) shares: Vec<Lanes>,
    /// For each model in turn, f_km − f_om, where o is the trajectory itself: φ̂ of the nearest samples (10).
    pub(crate) differences: Vec<Lanes>,
    /// Number of groups of samples.
    pub(crate) groups: usize,
}

/// The squared distance beyond which weights are below `floor` and are dropped. At a sample of the data, its own
/// trajectory has weight 1, the maximum.
pub(crate) fn squared_radius(sigma_squared: f64, floor: f64) -> f64 {
    // 2σ² might overflow if computed first.
    sigma_squared * (-2.0 * floor.ln())
}

impl Responsibilities {
    /// w_km = exp(−min_i ‖x_m − x_ki‖² / 2σ²) (11), q_km = w_km / Σ_j w_jm (12).
    pub(crate) fn new(nearest: &NearestSamples, potentials: &[Vec<f64>], sigma_squared: f64) -> Self {
        let owners = (0..nearest.n_trajectories()).into_par_iter();
        let blocks = owners.map(|owner| Block::new(owner, nearest, potentials, sigma_squared)).collect();
        Responsibilities { blocks }
    }

    /// Number K of trajectories.
    pub(crate) fn n_trajectories(&self) -> usize {
        self.blocks.len()
    }
}

impl Block {
    fn new(owner: usize, nearest: &NearestSamples, potentials: &[Vec<f64>], sigma_squared: f64) -> Self {
        let near = (0..potentials.len()).filter_map(|model| Some((model, nearest.of(owner, model)?)));
        let near: Vec<(usize, Nearest<'_>)> = near.collect();
        let own = near
            .iter()
            .find(|&&(model, _)| model == owner)
            .expect("a trajectory is within the search radius of itself")
            .1;
        let own: Vec<Lanes> = own.samples.iter().map(|samples| look_up(&potentials[owner], samples)).collect();
        let groups = groups_of(potentials[owner].len());
        let mut shares = Vec::with_capacity(groups * near.len());
        let mut differences = Vec::with_capacity(groups * near.len());
        for (model, nearest) in &near {
            let values = nearest.samples.iter().map(|samples| look_up(&potentials[*model], samples));
            differences
                .extend(values.zip(&own).map(|(value, own)| std::array::from_fn(|lane| value[lane] - own[lane])));
            shares.extend_from_slice(nearest.squared_distances);
        }
        to_weights(shares.as_flattened_mut(), sigma_squared, nearest.squared_radius());
        Arch::new().dispatch(Normalise { weights: &mut shares, groups });
        Block { models: near.into_iter().map(|(model, _)| model).collect(), shares, differences, groups }
    }

    /// (model, q, f minus f of the trajectory itself) for each model of the block.
    pub(crate) fn models(&self) -> impl Iterator<Item = (usize, &[Lanes], &[Lanes])> {
        let shares = self.shares.chunks_exact(self.groups);
        let differences = self.differences.chunks_exact(self.groups);
        self.models
            .iter()
            .zip(shares.zip(differences))
            .map(|(&model, (shares, differences))| (model, shares, differences))
    }
}

fn look_up(potential: &[f64], samples: &[u32; LANES]) -> Lanes {
    samples.map(|sample| potential[sample as usize])
}

/// Divides the weights of all models at a sample by their sum (12).
struct Normalise<'a> {
    weights: &'a mut [Lanes],
    groups: usize,
}

impl WithSimd for Normalise<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let mut total = vec![[0.0; LANES]; self.groups];
        for model in self.weights.chunks_exact(self.groups) {
            for (total, weight) in total.iter_mut().zip(model) {
                for lane in 0..LANES {
                    total[lane] += weight[lane];
                }
            }
        }
        // Padding samples have no weight, and 0 / 1 keeps them at 0.
        for total in total.as_flattened_mut() {
            *total = if *total > 0.0 { *total } else { 1.0 };
        }
        for model in self.weights.chunks_exact_mut(self.groups) {
            for (weight, total) in model.iter_mut().zip(&total) {
                for lane in 0..LANES {
                    weight[lane] /= total[lane];
                }
            }
        }
    }
}
