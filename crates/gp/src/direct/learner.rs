//! The direct GP as an implementation of the learners' common traits.

use motion::{Certainty, Demonstrations, LearnError, Learner, LearntPolicy, Policy, SampleIndex};
use nalgebra::{DMatrix, DMatrixView, DVectorView, DVectorViewMut};
use rand::Rng;
use serde::Serialize;

use crate::FrontEnd;
use crate::dimension::require;
use crate::direct::direct_gp::{DirectFit, DirectGp};
use crate::support::only_deviation_into;

/// The direct GP as a learner.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct DirectLearner {
    /// The front end, which turns recordings into rows.
    pub front_end: FrontEnd,
    /// The Gaussian process that is fitted to the rows.
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

    fn actions(&self, states: DMatrixView<'_, f64>) -> DMatrix<f64> {
        self.model.actions(states)
    }
}

impl LearntPolicy for DirectFit {
    fn support(&self, state: DVectorView<'_, f64>) -> f64 {
        self.certainty(state.as_view()).support[0]
    }

    fn action_sd_into(&self, state: DVectorView<'_, f64>, deviation: DVectorViewMut<'_, f64>) -> bool {
        only_deviation_into(&self.certainty(state.as_view()), deviation)
    }

    fn certainty(&self, states: DMatrixView<'_, f64>) -> Certainty {
        require(self.dim(), &[states.nrows()]);
        self.model.variances(states).certainty(self.z_squared.max(1.0), self.model.weights.nrows(), self.dim())
    }

    fn supported(&self, states: DMatrixView<'_, f64>, least: f64) -> Vec<bool> {
        require(self.dim(), &[states.nrows()]);
        self.model.supported(states, least)
    }

    fn warnings(&self) -> Vec<String> {
        self.doubts()
    }
}
