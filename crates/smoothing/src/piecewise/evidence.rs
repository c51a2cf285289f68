//! The evidence of a window for each degree, (S15).

use std::f64::consts::PI;

use crate::piecewise::windows::{Energy, MAX_COLUMNS};

/// Ratio of the offset's prior variance to the samples' variance: τ₀² = 4c.
const OFFSET_VARIANCE: f64 = 4.0;

/// Factor between the prior standard deviations of consecutive degrees: τ_k² = c · 0.15^(2k).
const DECAY: f64 = 0.15;

/// The noise model for one noise variance s²: the quantities in (S15) besides a window's energy.
#[derive(Debug)]
pub(crate) struct NoiseModel<'a> {
    pub(crate) degrees: &'a [usize],
    /// s², in squared units of the scaled axes.
    pub(crate) noise_variance: f64,
    dim: f64,
    /// One for each number of samples, from 2 on.
    shrinkage: Vec<Shrinkage>,
}

/// Quantities shared by windows of one length.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shrinkage {
    /// f_k = V_k/(V_k + s²), V_k = n·τ_k².
    pub(crate) factors: [f64; MAX_COLUMNS],
    /// Σ_{l≤k} log(1 + V_l/s²).
    log_determinants: [f64; MAX_COLUMNS],
}

impl<'a> NoiseModel<'a> {
    /// `variance` is c, the samples' own variance; `dim` the number of axes.
    pub(crate) fn new(degrees: &'a [usize], longest: usize, dim: usize, variance: f64, noise_variance: f64) -> Self {
        let shrinkage = (2..=longest).map(|samples| Shrinkage::new(samples, variance, noise_variance)).collect();
        NoiseModel { degrees, noise_variance, dim: dim as f64, shrinkage }
    }

    pub(crate) fn shrinkage(&self, samples: usize) -> &Shrinkage {
        &self.shrinkage[samples - 2]
    }

    /// log ev(a, b, p) for each degree in the given order; −∞ if the window has too few samples for it.
    pub(crate) fn log_evidence(&self, samples: usize, energy: &Energy, by_degree: &mut [f64]) {
        let Shrinkage { factors, log_determinants, .. } = self.shrinkage(samples);
        let mut explained = [0.0; MAX_COLUMNS];
        let mut sum = 0.0;
        for k in 0..MAX_COLUMNS {
            sum += factors[k] * energy.of_degree[k];
            explained[k] = sum;
        }
        let s2 = self.noise_variance;
        let scale = samples as f64 * self.dim * (2.0 * PI * s2).ln();
        let choice = (self.degrees.len() as f64).ln();
        for (&degree, log_evidence) in self.degrees.iter().zip(by_degree) {
            *log_evidence = if degree < samples {
                let misfit = (energy.total - explained[degree]) / s2;
                -0.5 * (misfit + self.dim * log_determinants[degree] + scale) - choice
            } else {
                f64::NEG_INFINITY
            };
        }
    }
}

impl Shrinkage {
    fn new(samples: usize, variance: f64, noise_variance: f64) -> Self {
        let mut shrinkage = Shrinkage { factors: [0.0; MAX_COLUMNS], log_determinants: [0.0; MAX_COLUMNS] };
        let (mut sum, mut decay) = (0.0, 1.0);
        for k in 0..MAX_COLUMNS {
            let tau_squared = variance * if k == 0 { OFFSET_VARIANCE } else { decay };
            let prior = samples as f64 * tau_squared;
            sum += (prior / noise_variance).ln_1p();
            shrinkage.factors[k] = prior / (prior + noise_variance);
            shrinkage.log_determinants[k] = sum;
            decay *= DECAY * DECAY;
        }
        shrinkage
    }
}

/// log Σ exp.
pub(crate) fn log_sum_exp(terms: &[f64]) -> f64 {
    let largest = terms.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if largest == f64::NEG_INFINITY {
        return largest;
    }
    largest + terms.iter().map(|term| (term - largest).exp()).sum::<f64>().ln()
}
