//! The seam: what both learners and both policies share with all others.

use motion::{Demonstrations, LearnError, Learner, LearntPolicy, Policy, Potential, SampleIndex, SampleSet};
use nalgebra::{DMatrix, DVectorView, DVectorViewMut};
use rand::Rng;
use serde::Serialize;

use crate::direct_gp::{DirectFit, DirectGp};
use crate::slope_fit::SlopeFit;
use crate::slope_gp::SlopeGp;
use crate::slope_policy::{SlopePolicy, SlopePotential};
use crate::trust_report::TrustReport;
use crate::{FrontEnd, GpError, Rows};

/// The slope GP as a learner: what was recorded, and what is made of it.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct SlopeLearner {
    /// How recordings become rows.
    pub front_end: FrontEnd,
    /// What learns from them.
    pub gp: SlopeGp,
}

/// The direct GP as a learner.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct DirectLearner {
    /// How recordings become rows.
    pub front_end: FrontEnd,
    /// What learns from them.
    pub gp: DirectGp,
}

impl Learner for SlopeLearner {
    fn learn(
        &self,
        demonstrations: &Demonstrations,
        held_out: &[SampleIndex],
        rng: &mut dyn Rng,
    ) -> Result<Box<dyn LearntPolicy>, LearnError> {
        Ok(Box::new(self.gp.fit(&seen(&self.front_end, demonstrations, held_out)?, rng)?))
    }
}

impl Learner for DirectLearner {
    fn learn(
        &self,
        demonstrations: &Demonstrations,
        held_out: &[SampleIndex],
        rng: &mut dyn Rng,
    ) -> Result<Box<dyn LearntPolicy>, LearnError> {
        Ok(Box::new(self.gp.fit(&seen(&self.front_end, demonstrations, held_out)?, rng)?))
    }
}

/// The rows of samples that are not held out.
pub(crate) fn seen(
    front_end: &FrontEnd,
    demonstrations: &Demonstrations,
    held_out: &[SampleIndex],
) -> Result<Rows, GpError> {
    let held_out = SampleSet::of(held_out);
    let rows = front_end.rows(demonstrations)?;
    Ok(rows.without(|trajectory, sample| held_out.contains(SampleIndex { trajectory, sample })))
}

impl SlopeFit {
    /// π̂.
    pub fn policy(&self) -> &SlopePolicy {
        self.model.policy()
    }

    /// φ̂; none if the model allows for rotation.
    pub fn potential(&self) -> Option<&SlopePotential> {
        self.model.potential()
    }

    /// (S13): cov π(x), (n, n), in squared units of the state per second, not yet times max(1, z²). Costs n M².
    pub fn uncertainty(&self, state: DVectorView<'_, f64>) -> DMatrix<f64> {
        self.model.covariance(state)
    }

    /// φ̂(x) − φ̂(x₀) and its variance (S14); none if there is no potential.
    pub fn potential_difference(&self, x: DVectorView<'_, f64>, from: DVectorView<'_, f64>) -> Option<(f64, f64)> {
        self.model.potential_difference(x, from)
    }

    /// How far to trust it.
    pub fn report(&self) -> &TrustReport {
        &self.report
    }
}

impl Policy for SlopeFit {
    fn dim(&self) -> usize {
        self.model.policy().dim()
    }

    fn action_into(&self, state: DVectorView<'_, f64>, action: DVectorViewMut<'_, f64>) {
        self.model.policy().action_into(state, action);
    }
}

impl LearntPolicy for SlopeFit {
    fn potential(&self) -> Option<&dyn Potential> {
        self.model.potential().map(|potential| potential as &dyn Potential)
    }

    fn support(&self, state: DVectorView<'_, f64>) -> f64 {
        1.0 - (self.model.covariance(state).trace() / self.model.prior_covariance(state).trace()).clamp(0.0, 1.0)
    }

    fn action_sd_into(&self, state: DVectorView<'_, f64>, mut deviation: DVectorViewMut<'_, f64>) -> bool {
        let factor = self.report.z_squared.max(1.0);
        let variances = self.model.covariance(state).diagonal();
        deviation.copy_from(&variances.map(|variance| (factor * variance.max(0.0)).sqrt()));
        true
    }

    fn warnings(&self) -> Vec<String> {
        self.report.warnings()
    }
}

impl Policy for DirectFit {
    fn dim(&self) -> usize {
        self.model.dim()
    }

    fn action_into(&self, state: DVectorView<'_, f64>, action: DVectorViewMut<'_, f64>) {
        self.model.action_into(state, action);
    }
}

impl LearntPolicy for DirectFit {
    fn support(&self, state: DVectorView<'_, f64>) -> f64 {
        1.0 - (self.model.variance(state) / self.model.prior_variance(state)).clamp(0.0, 1.0)
    }

    fn action_sd_into(&self, state: DVectorView<'_, f64>, mut deviation: DVectorViewMut<'_, f64>) -> bool {
        deviation.fill((self.z_squared.max(1.0) * self.model.variance(state).max(0.0)).sqrt());
        true
    }

    fn warnings(&self) -> Vec<String> {
        self.doubts()
    }
}
