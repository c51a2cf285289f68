//! The direct GP behind the traits of all learners.

use motion::{Demonstrations, LearnError, Learner, LearntPolicy, Policy, SampleIndex};
use nalgebra::{DVectorView, DVectorViewMut};
use rand::Rng;
use serde::Serialize;

use crate::FrontEnd;
use crate::direct::direct_gp::{DirectFit, DirectGp};
use crate::support::support;

/// The direct GP as a learner.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct DirectLearner {
    /// How recordings become rows.
    pub front_end: FrontEnd,
    /// The Gaussian process fitted to them.
    pub gp: DirectGp,
}

impl Learner for DirectLearner {
    fn learn(
        &self,
        demonstrations: &Demonstrations,
        held_out: &[SampleIndex],
        rng: &mut dyn Rng,
    ) -> Result<Box<dyn LearntPolicy>, LearnError> {
        Ok(Box::new(self.gp.fit(&self.front_end.rows_but(demonstrations, held_out)?, rng)?))
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
        support(self.model.variance(state), self.model.prior_variance(state))
    }

    fn action_sd_into(&self, state: DVectorView<'_, f64>, mut deviation: DVectorViewMut<'_, f64>) -> bool {
        deviation.fill(0.0);
        let mut moving = deviation.rows_mut(0, self.model.weights.nrows());
        moving.fill((self.z_squared.max(1.0) * self.model.variance(state).max(0.0)).sqrt());
        true
    }

    fn warnings(&self) -> Vec<String> {
        self.doubts()
    }
}
