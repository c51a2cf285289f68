use rayon::prelude::*;

use crate::responsibilities::{Block, Responsibilities};

/// a (16), (K), and E₀ of the objective among a group of trajectories, once each of them is raised by its offset.
/// Trajectories without an offset are outside: their entries are 0 and their models take no part.
///
/// Raised by b, a group of all trajectories has a + Hb: half the gradient of the objective at b.
pub(crate) fn linear_term(responsibilities: &Responsibilities, offsets: &[Option<f64>]) -> (Vec<f64>, f64) {
    let blocks = responsibilities.blocks.par_iter().enumerate();
    let terms: Vec<_> = blocks.map(|(owner, block)| block_term(block, owner, offsets)).collect();
    let mut linear = vec![0.0; offsets.len()];
    let mut constant = 0.0;
    for (block, (flows, misfit)) in responsibilities.blocks.iter().zip(terms) {
        block.models.iter().zip(flows).for_each(|(&model, flow)| linear[model] += flow);
        constant += misfit;
    }
    (linear, constant)
}

/// What the samples of one trajectory add: one number for each model of its block, and the constant.
///
/// With s = Σ_j q_j over the group, v = f + b and v̄ = Σ_j q_j v_j / s: Σ_j q_k q_j (v_k − v_j) = s q_k (v_k − v̄),
/// and ½ Σ_k Σ_j q_k q_j (v_k − v_j)² = s Σ_k q_k (v_k − v̄)². Values are taken relative to the trajectory's own model,
/// which nearly always has most of the weight, so that what weak links say is not lost in rounding.
fn block_term(block: &Block, owner: usize, offsets: &[Option<f64>]) -> (Vec<f64>, f64) {
    let member = |&(model, ..): &(usize, &[f64], &[f64])| offsets[model].is_some();
    let mut flows = vec![0.0; block.models.len()];
    let Some(reference) = block.models().filter(member).max_by_key(|&(model, ..)| model == owner) else {
        return (flows, 0.0);
    };
    let (_, _, origin) = reference;
    let origin_offset = offsets[reference.0].unwrap_or(0.0);

    let mut total = vec![0.0; block.n_samples];
    let mut mean = vec![0.0; block.n_samples];
    for (model, shares, values) in block.models().filter(member) {
        let rise = offsets[model].unwrap_or(0.0) - origin_offset;
        for m in 0..block.n_samples {
            total[m] += shares[m];
            mean[m] += shares[m] * (values[m] - origin[m] + rise);
        }
    }
    mean.iter_mut().zip(&total).filter(|(_, total)| **total > 0.0).for_each(|(mean, total)| *mean /= total);

    let mut misfit = 0.0;
    for (flow, (model, shares, values)) in flows.iter_mut().zip(block.models()) {
        let Some(offset) = offsets[model] else { continue };
        for m in 0..block.n_samples {
            let deviation = values[m] - origin[m] + (offset - origin_offset) - mean[m];
            let weighted = total[m] * shares[m] * deviation;
            *flow += weighted;
            misfit += weighted * deviation;
        }
    }
    (flows, misfit)
}
