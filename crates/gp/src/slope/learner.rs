//! The slope GP behind the traits of all learners.

use motion::{Demonstrations, LearnError, Learner, LearntPolicy, Policy, Potential, SampleIndex};
use nalgebra::{DVectorView, DVectorViewMut};
use rand::Rng;
use serde::Serialize;

use crate::FrontEnd;
use crate::slope::fit::SlopeFit;
use crate::slope::slope_gp::SlopeGp;
use crate::support::support;

/// The slope GP as a learner, with the front end that makes its rows.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct SlopeLearner {
    /// How recordings become rows.
    pub front_end: FrontEnd,
    /// The Gaussian process fitted to them.
    pub gp: SlopeGp,
}

impl Learner for SlopeLearner {
    fn learn(
        &self,
        demonstrations: &Demonstrations,
        held_out: &[SampleIndex],
        rng: &mut dyn Rng,
    ) -> Result<Box<dyn LearntPolicy>, LearnError> {
        Ok(Box::new(self.gp.fit(&self.front_end.rows_but(demonstrations, held_out)?, rng)?))
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
        support(self.model.covariance(state).trace(), self.model.prior_covariance(state).trace())
    }

    fn action_sd_into(&self, state: DVectorView<'_, f64>, mut deviation: DVectorViewMut<'_, f64>) -> bool {
        let factor = self.report.variance_factor();
        let variances = self.model.covariance(state).diagonal();
        deviation.fill(0.0);
        let mut moving = deviation.rows_mut(0, variances.len());
        moving.copy_from(&variances.map(|variance| (factor * variance.max(0.0)).sqrt()));
        true
    }

    fn warnings(&self) -> Vec<String> {
        self.report.warnings()
    }
}
