#![allow(clippy::inline_always, reason = "vector instructions reach only what is inlined")]

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::compensated::CompensatedSum;
use super::responsibilities::{Block, Responsibilities};
use lanes::{LANES, Lanes};

/// a (16), (K), and E₀ of the objective among a group of trajectories, after shifting each by its offset. Trajectories
/// without an offset are outside: their entries are 0, and their models are not used.
///
/// After a shift by b, all trajectories together have a + Hb: half the gradient of the objective at b.
pub(crate) fn linear_term(responsibilities: &Responsibilities, offsets: &[Option<f64>]) -> (Vec<f64>, f64) {
    let blocks = responsibilities.blocks.par_iter().enumerate();
    let terms: Vec<_> = blocks.map(|(owner, block)| block_term(block, owner, offsets)).collect();
    let mut linear = vec![CompensatedSum::default(); offsets.len()];
    let mut constant = CompensatedSum::default();
    for (block, term) in responsibilities.blocks.iter().zip(terms) {
        let Some(BlockTerm { reference, flows, misfit }) = term else { continue };
        // The flow into a model equals the flow out of the reference. Both have the same rounding, so that the rounding
        // of strong links does not hide a weak link.
        for (&model, flow) in block.models.iter().zip(flows).filter(|&(&model, _)| model != reference) {
            linear[model].add(flow);
            linear[reference].add(-flow);
        }
        constant.add(misfit);
    }
    (linear.iter().map(CompensatedSum::value).collect(), constant.value())
}

/// The contribution of one trajectory's samples.
struct BlockTerm {
    /// The trajectory itself, or the first member of the group if the trajectory is outside.
    reference: usize,
    /// Σ_m Σ_j q_km q_jm (v_km − v_jm) for each model k of the block, 0 for models outside the group.
    flows: Vec<f64>,
    /// ½ Σ_m Σ_k Σ_j q_km q_jm (v_km − v_jm)².
    misfit: f64,
}

fn block_term(block: &Block, owner: usize, offsets: &[Option<f64>]) -> Option<BlockTerm> {
    let first = block.models.iter().copied().find(|&model| offsets[model].is_some())?;
    let reference = if offsets[owner].is_some() { owner } else { first };
    // Values are relative to those of the trajectory itself, which has most of the weight.
    let level = offsets[owner].unwrap_or(0.0);
    let (flows, misfit) = Arch::new().dispatch(Flows { block, offsets, level });
    Some(BlockTerm { reference, flows, misfit })
}

/// With v = f + b, s = Σ_j q_j over the group and v̄ = Σ_j q_j v_j / s,
/// Σ_j q_k q_j (v_k − v_j) = s q_k (v_k − v̄) and ½ Σ_k Σ_j q_k q_j (v_k − v_j)² = s Σ_k q_k (v_k − v̄)².
struct Flows<'a> {
    block: &'a Block,
    offsets: &'a [Option<f64>],
    level: f64,
}

impl WithSimd for Flows<'_> {
    type Output = (Vec<f64>, f64);

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) -> Self::Output {
        let mut share = vec![[0.0; LANES]; self.block.groups];
        let mut mean = vec![[0.0; LANES]; self.block.groups];
        for (model, q, differences) in self.block.models() {
            if let Some(offset) = self.offsets[model] {
                add_to_mean(q, differences, offset - self.level, &mut share, &mut mean);
            }
        }
        for (mean, share) in mean.as_flattened_mut().iter_mut().zip(share.as_flattened()) {
            *mean /= if *share > 0.0 { *share } else { 1.0 };
        }
        let mut flows = vec![0.0; self.block.models.len()];
        let mut misfit = 0.0;
        for ((model, q, differences), flow) in self.block.models().zip(&mut flows) {
            if let Some(offset) = self.offsets[model] {
                let (sum, square) = deviation(q, differences, offset - self.level, &share, &mean);
                *flow = sum;
                misfit += square;
            }
        }
        (flows, misfit)
    }
}

#[inline(always)]
fn add_to_mean(q: &[Lanes], differences: &[Lanes], offset: f64, share: &mut [Lanes], mean: &mut [Lanes]) {
    for (((q, differences), share), mean) in q.iter().zip(differences).zip(share).zip(mean) {
        for lane in 0..LANES {
            share[lane] += q[lane];
            mean[lane] += q[lane] * (differences[lane] + offset);
        }
    }
}

/// Σ s q (v − v̄) and Σ s q (v − v̄)².
#[inline(always)]
fn deviation(q: &[Lanes], differences: &[Lanes], offset: f64, share: &[Lanes], mean: &[Lanes]) -> (f64, f64) {
    let mut flow = [0.0; LANES];
    let mut misfit = [0.0; LANES];
    for (((q, differences), share), mean) in q.iter().zip(differences).zip(share).zip(mean) {
        for lane in 0..LANES {
            let deviation = differences[lane] + offset - mean[lane];
            let weighted = share[lane] * q[lane] * deviation;
            flow[lane] += weighted;
            misfit[lane] += weighted * deviation;
        }
    }
    (flow.iter().sum(), misfit.iter().sum())
}
