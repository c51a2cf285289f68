//! The common method of all experiments: one regression, LWPR with its library's defaults, and one share of held-out samples.

use align::{DirectPolicyLearning, LwprRegressor, PolicyAlign};
use lwpr::LwprParams;
use nalgebra::DVector;

use crate::Setup;
use crate::evaluation::candidate::Candidate;
use crate::evaluation::protocol::Protocol;
use crate::setting::{Class, SILENT, Setting};

/// The common settings of an experiment's learners.
#[derive(Debug, Clone)]
pub(crate) struct Recipe {
    /// LWPR's parameters without divisors: the library's defaults.
    pub(crate) params: LwprParams,
    /// Divisor of potentials before LWPR learns them: 1, as in (23).
    pub(crate) divisor: f64,
    /// Passes over all samples per input dimension, because a receptive field with n inputs predicts only after 2n samples.
    pub(crate) passes_per_input: f64,
    /// Receptive fields with a smaller activation do not contribute to a prediction.
    pub(crate) cutoff: f64,
    /// Share of samples that are held out for tests.
    pub(crate) held_out: f64,
}

impl Default for Recipe {
    fn default() -> Self {
        Recipe { params: LwprParams::default(), divisor: 1.0, passes_per_input: 1.0, cutoff: 1e-3, held_out: HELD_OUT }
    }
}

/// Share of held-out samples.
pub const HELD_OUT: f64 = 0.2;

impl Recipe {
    /// The regression on aligned potentials with `dim` inputs, all divided by `spread`.
    pub(crate) fn regressor(&self, dim: usize, spread: f64) -> LwprRegressor {
        self.lwpr(dim, spread, 1)
    }

    /// The naive learner's regression on observed velocities.
    pub(crate) fn naive(&self, dim: usize, spread: f64) -> DirectPolicyLearning {
        DirectPolicyLearning { regressor: self.lwpr(dim, spread, dim) }
    }

    /// PolicyAlign alone, with this regression; other learners can be added.
    pub(crate) fn protocol(&self, algorithm: PolicyAlign, dim: usize, spread: f64) -> Protocol {
        let candidates = vec![Candidate::PolicyAlign(self.regressor(dim, spread))];
        Protocol { algorithm, candidates, held_out: self.held_out }
    }

    fn passes(&self, dim: usize) -> usize {
        (self.passes_per_input * dim as f64).ceil() as usize
    }

    /// A regression with `n_out` outputs.
    fn lwpr(&self, dim: usize, spread: f64, n_out: usize) -> LwprRegressor {
        let [norm_in, norm_out] =
            [(dim, spread), (n_out, self.divisor)].map(|(n, norm)| Some(DVector::repeat(n, norm)));
        let params = LwprParams { norm_in, norm_out, ..self.params.clone() };
        LwprRegressor { params, passes: self.passes(dim), cutoff: self.cutoff }
    }

    /// The fitted values of the recipe, as settings of an experiment whose printed rows are `printed`.
    pub(crate) fn settings(
        &self,
        experiment: &'static str,
        printed: fn(&Recipe) -> anyhow::Result<Vec<Setup>>,
    ) -> Vec<Setting> {
        let changed = |change: fn(&mut Recipe, f64)| {
            let base = self.clone();
            move |value| {
                let mut recipe = base.clone();
                change(&mut recipe, value);
                printed(&recipe)
            }
        };
        let fitted =
            |name, paper, used, change| Setting::new(experiment, name, Class::Fitted, paper, used, changed(change));
        vec![
            fitted("held-out share", "\"a subsample\"", self.held_out, |recipe, share| recipe.held_out = share),
            fitted("passes for each input, rounded up", SILENT, self.passes_per_input, |recipe, passes| {
                recipe.passes_per_input = passes;
            }),
        ]
    }
}
