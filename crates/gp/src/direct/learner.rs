//! The direct GP behind the traits of all learners.

use motion::{Demonstrations, LearnError, Learner, LearntPolicy, Policy, SampleIndex};
use nalgebra::{DMatrix, DVectorView, DVectorViewMut};
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

    fn supports(&self, states: &DMatrix<f64>) -> Vec<f64> {
        let each = states.column_iter().zip(self.model.variances(states));
        each.map(|(state, variance)| support(variance, self.model.prior_variance(state))).collect()
    }

    fn action_sd_into(&self, state: DVectorView<'_, f64>, deviation: DVectorViewMut<'_, f64>) -> bool {
        self.deviation_into(self.model.variance(state), deviation);
        true
    }

    fn action_sds(&self, states: &DMatrix<f64>) -> Option<DMatrix<f64>> {
        let mut deviations = DMatrix::zeros(states.nrows(), states.ncols());
        let each = deviations.column_iter_mut().zip(self.model.variances(states));
        each.for_each(|(deviation, variance)| self.deviation_into(variance, deviation));
        Some(deviations)
    }

    fn warnings(&self) -> Vec<String> {
        self.doubts()
    }
}

impl DirectFit {
    /// Of a variance (R4), with 0 along the context.
    fn deviation_into(&self, variance: f64, mut deviation: DVectorViewMut<'_, f64>) {
        deviation.fill(0.0);
        let mut moving = deviation.rows_mut(0, self.model.weights.nrows());
        moving.fill((self.z_squared.max(1.0) * variance.max(0.0)).sqrt());
    }
}
