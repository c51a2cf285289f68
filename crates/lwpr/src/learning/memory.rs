//! Distances that one pass over a batch has found, for the next: while no metric adapts they stay as they are.

use crate::MetricAdaptation;
use crate::settings::Settings;

/// Samples, times outputs, for which distances are remembered at most.
const MOST: usize = 1 << 20;

/// For each output and each sample of a batch the fields that it activates.
#[derive(Debug)]
pub(crate) struct Memory {
    outputs: Vec<Vec<KnownDistances>>,
}

/// The fields that a sample activates, among those that it has been compared with.
#[derive(Debug, Clone, Default)]
pub(crate) struct KnownDistances {
    pub(super) fields: Vec<usize>,
    pub(super) q: Vec<f64>,
    pub(super) n_compared: usize,
}

impl Memory {
    /// For as many passes over as many samples; `None` where metrics adapt, fields vanish, or finding the activated fields is
    /// quick anyway.
    pub(crate) fn new(settings: &Settings, n_samples: usize, passes: usize) -> Option<Self> {
        let stays = settings.params.adaptation == MetricAdaptation::Fixed && settings.params.w_prune == 1.0;
        let pays = passes > 1 && !settings.narrow() && n_samples.saturating_mul(settings.n_out) <= MOST;
        (stays && pays).then(|| Memory { outputs: vec![vec![KnownDistances::default(); n_samples]; settings.n_out] })
    }

    #[inline(always)]
    pub(crate) fn of(&mut self, output: usize, sample: usize) -> &mut KnownDistances {
        &mut self.outputs[output][sample]
    }
}
