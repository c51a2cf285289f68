//! The noise variance with the highest marginal likelihood.

use motion::median;
use rayon::prelude::*;

use crate::noise::differences;
use crate::piecewise::scaled::Scaled;
use crate::piecewise::windows::{Bases, Energy, energies};

/// Largest number of trajectories, evenly spread, from which the noise is estimated.
const TRAJECTORIES: usize = 12;

/// Hill climbing over log₁₀ s²: first step, divisor of the step at a maximum, smallest step, largest number of rounds.
const FIRST_STEP: f64 = 1.0;
const REFINEMENT: f64 = 2.5;
const LAST_STEP: f64 = 0.06;
const ROUNDS: usize = 12;

/// Least s², in units of the samples' variance; below it, rounding errors dominate the evidence.
const LEAST: f64 = 1e-13;

/// Index and window energies of each trajectory from which the noise is estimated.
pub(crate) type SomeEnergies = Vec<(usize, Vec<Energy>)>;

/// Energies of up to 12 evenly spread trajectories.
pub(crate) fn some_energies(scaled: &Scaled<'_>, bases: &Bases, longest: usize) -> SomeEnergies {
    let all = scaled.movements.len();
    let chosen: Vec<usize> = (0..all.min(TRAJECTORIES)).map(|i| i * all / all.min(TRAJECTORIES)).collect();
    chosen.into_par_iter().map(|k| (k, energies(&scaled.movements[k], bases, longest))).collect()
}

/// s² with the highest evidence, found by hill climbing from the estimate by third differences.
///
/// `log_evidence` sums (S16) over trajectories at a given s².
pub(crate) fn most_likely(scaled: &Scaled<'_>, log_evidence: impl Fn(f64) -> f64) -> f64 {
    let least = (LEAST * scaled.variance).log10();
    let evidence_at = |log10: f64| log_evidence(10f64.powf(log10));
    let mut at = first_guess(scaled).log10().max(least);
    let mut best = evidence_at(at);
    let mut step = FIRST_STEP;
    for _ in 0..ROUNDS {
        if step < LAST_STEP {
            break;
        }
        let neighbours = [(at - step).max(least), at + step].map(|log10| (log10, evidence_at(log10)));
        let better = if neighbours[0].1 >= neighbours[1].1 { neighbours[0] } else { neighbours[1] };
        if better.1 > best {
            (at, best) = better;
        } else {
            step /= REFINEMENT;
        }
    }
    10f64.powf(at)
}

/// (median |third difference| / 0.6745)² / 20 over all axes; 20 is the sum of the squared binomials.
fn first_guess(scaled: &Scaled<'_>) -> f64 {
    let differences: Vec<f64> = scaled
        .movements
        .iter()
        .flat_map(|movement| {
            (0..movement.dim).flat_map(|j| differences::<4>(&movement.rows, movement.dim, j, movement.recorded.times()))
        })
        .collect();
    let deviation = median(differences).unwrap_or(0.0) / 0.6745;
    deviation * deviation / 20.0 + 1e-16 * scaled.variance
}
