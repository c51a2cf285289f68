//! The slope GP behind the traits of all learners.

use motion::{Demonstrations, LearnError, Learner, LearntPolicy, Policy, Potential, SampleIndex};
use nalgebra::{DMatrix, DVectorView, DVectorViewMut};
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

    fn supports(&self, states: &DMatrix<f64>) -> Vec<f64> {
        let of = |(state, posterior): (DVectorView<'_, f64>, DMatrix<f64>)| {
            support(posterior.trace(), self.model.prior_covariance(state).trace())
        };
        states.column_iter().zip(self.covariances(states)).map(of).collect()
    }

    fn action_sd_into(&self, state: DVectorView<'_, f64>, deviation: DVectorViewMut<'_, f64>) -> bool {
        self.deviation_into(&self.model.covariance(state), deviation);
        true
    }

    fn action_sds(&self, states: &DMatrix<f64>) -> Option<DMatrix<f64>> {
        let mut deviations = DMatrix::zeros(states.nrows(), states.ncols());
        let each = deviations.column_iter_mut().zip(self.covariances(states));
        each.for_each(|(deviation, covariance)| self.deviation_into(&covariance, deviation));
        Some(deviations)
    }

    fn warnings(&self) -> Vec<String> {
        self.report.warnings()
    }
}

/// States whose triangular systems are solved together.
const TOGETHER: usize = 32;

impl SlopeFit {
    /// (S13) at each of some states, (n + p, N).
    fn covariances(&self, states: &DMatrix<f64>) -> Vec<DMatrix<f64>> {
        let states: Vec<DVectorView<'_, f64>> = states.column_iter().collect();
        states.chunks(TOGETHER).flat_map(|states| self.model.covariances(states)).collect()
    }

    /// Of a covariance (S13), with 0 along the context.
    fn deviation_into(&self, covariance: &DMatrix<f64>, mut deviation: DVectorViewMut<'_, f64>) {
        let factor = self.report.variance_factor();
        let variances = covariance.diagonal();
        deviation.fill(0.0);
        let mut moving = deviation.rows_mut(0, variances.len());
        moving.copy_from(&variances.map(|variance| (factor * variance.max(0.0)).sqrt()));
    }
}
