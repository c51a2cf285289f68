//! From aligned potentials to a global potential and its policy (23).

use motion::SampleIndex;
use rand::Rng;

use crate::{AlignError, Aligned, LwprRegressor, Origin, PotentialPolicy, Regressor, Samples};

impl Aligned {
    /// Learns the policy from all samples of the kept trajectories.
    ///
    /// # Errors
    /// [`AlignError::Lwpr`] for parameters out of range.
    pub fn learn(&self, regressor: &LwprRegressor, rng: &mut dyn Rng) -> Result<PotentialPolicy, AlignError> {
        self.learn_without(&[], regressor, rng)
    }

    /// Learns the policy from all samples of the kept trajectories except those held out.
    ///
    /// # Errors
    /// As [`Aligned::learn`], and [`AlignError::NoSamples`] if no sample remains.
    pub fn learn_without(
        &self,
        held_out: &[SampleIndex],
        regressor: &LwprRegressor,
        rng: &mut dyn Rng,
    ) -> Result<PotentialPolicy, AlignError> {
        let potential = self.regress(regressor, &self.samples().without(held_out), rng)?;
        let warnings = self.warnings().iter().map(ToString::to_string).collect();
        let origin = Origin { kept: Some(self.kept().to_vec()), warnings, ..Origin::new(self.demonstrations()) };
        Ok(PotentialPolicy::new(potential, origin))
    }

    /// Learns the global potential (23) from all or some of the samples, by any regressor.
    ///
    /// # Errors
    /// The errors of the regressor.
    pub fn regress<G: Regressor + ?Sized>(
        &self,
        regressor: &G,
        samples: &Samples<'_>,
        rng: &mut dyn Rng,
    ) -> Result<G::Fitted, G::Error> {
        regressor.fit(&samples.states(), &samples.values(), rng)
    }
}
