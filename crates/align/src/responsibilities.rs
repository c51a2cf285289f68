use rayon::prelude::*;

use crate::exponential::to_weights;
use crate::nearest::NearestSamples;

/// The responsibilities q_km (12) of the local models for all samples, and what those models say there.
///
/// One block holds the samples of one trajectory. Most models are far from it and have no part in it.
#[derive(Debug)]
pub(crate) struct Responsibilities {
    pub(crate) blocks: Vec<Block>,
}

/// The samples of one trajectory, as all local models see them.
#[derive(Debug, Default)]
pub(crate) struct Block {
    /// The models with a responsibility above the floor at some sample, ascending.
    pub(crate) models: Vec<usize>,
    /// q_km: for each model in turn, one value a sample.
    pub(crate) shares: Vec<f64>,
    /// f_km, φ̂ of the model's nearest sample (10), in the same order.
    pub(crate) values: Vec<f64>,
    pub(crate) n_samples: usize,
}

impl Responsibilities {
    /// w_km = exp(−min_i ‖x_m − x_ki‖² / 2σ²) (11), q_km = w_km / Σ_j w_jm (12).
    ///
    /// At a sample of the data the own trajectory has weight 1, the largest there can be: weights below `floor` are
    /// dropped.
    pub(crate) fn new(nearest: &NearestSamples, potentials: &[Vec<f64>], sigma_squared: f64, floor: f64) -> Self {
        let reach = 2.0 * sigma_squared * -floor.ln();
        let owners = (0..nearest.n_trajectories()).into_par_iter();
        let blocks = owners.map(|owner| Block::new(owner, nearest, potentials, sigma_squared, reach)).collect();
        Responsibilities { blocks }
    }

    /// Number K of trajectories.
    pub(crate) fn n_trajectories(&self) -> usize {
        self.blocks.len()
    }
}

impl Block {
    fn new(owner: usize, nearest: &NearestSamples, potentials: &[Vec<f64>], sigma_squared: f64, reach: f64) -> Self {
        let n_samples = potentials[owner].len();
        let mut block = Block { n_samples, ..Block::default() };
        let mut total = vec![0.0; n_samples];
        for (model, potential) in potentials.iter().enumerate() {
            let nearest = nearest.of(owner, model);
            if nearest.smallest() > reach {
                continue;
            }
            let start = block.shares.len();
            block.models.push(model);
            block.values.extend(nearest.samples.iter().map(|&sample| potential[sample as usize]));
            block.shares.extend_from_slice(&nearest.squared_distances);
            let weights = &mut block.shares[start..];
            to_weights(weights, sigma_squared, reach);
            total.iter_mut().zip(weights).for_each(|(total, weight)| *total += *weight);
        }
        for shares in block.shares.chunks_exact_mut(n_samples) {
            shares.iter_mut().zip(&total).for_each(|(share, total)| *share /= total);
        }
        block
    }

    /// (model, q_m, f_m) for each model of the block, with one share and one value a sample.
    pub(crate) fn models(&self) -> impl Iterator<Item = (usize, &[f64], &[f64])> {
        let shares = self.shares.chunks_exact(self.n_samples);
        let values = self.values.chunks_exact(self.n_samples);
        self.models.iter().zip(shares.zip(values)).map(|(&model, (shares, values))| (model, shares, values))
    }
}
