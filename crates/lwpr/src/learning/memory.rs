//! Distances that one pass over a batch found, for reuse in the next: they are constant as long as no metric adapts.

use crate::MetricAdaptation;
use crate::settings::Settings;

/// Maximum number of samples, times outputs, whose distances are stored.
const MOST: usize = 1 << 20;

/// For each output and each sample of a batch, the activated fields.
#[derive(Debug)]
pub(crate) struct Memory {
    outputs: Vec<Vec<KnownDistances>>,
}

/// The fields activated by a sample, among those to which it has been compared.
#[derive(Debug, Clone, Default)]
pub(crate) struct KnownDistances {
    pub(super) fields: Vec<usize>,
    pub(super) q: Vec<f64>,
    pub(super) n_compared: usize,
}

impl Memory {
    /// For `passes` passes over `n_samples` samples; `None` if metrics adapt, if fields are removed, or if finding the
    /// activated fields is fast anyway.
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
