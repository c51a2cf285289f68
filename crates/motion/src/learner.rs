use std::fmt::Debug;

use nalgebra::{DMatrix, DVectorView, DVectorViewMut};
use rand::Rng;

use crate::{Demonstrations, Policy, Potential, SampleIndex};

/// Why a learner could not learn; each learner's own error, whose message says what, where and what next.
pub type LearnError = Box<dyn std::error::Error + Send + Sync>;

/// A method that learns a policy from demonstrations.
///
/// A learner is a plain set of parameters. `Debug` prints all of them: equal texts mean equal learners.
pub trait Learner: Debug + Send + Sync {
    /// Learns from all samples but those held out, which may come in any order. The same generator gives the same bits
    /// at any number of threads.
    ///
    /// # Errors
    /// [`LearnError`] for parameters out of range, or demonstrations that the learner cannot use.
    fn learn(
        &self,
        demonstrations: &Demonstrations,
        held_out: &[SampleIndex],
        rng: &mut dyn Rng,
    ) -> Result<Box<dyn LearntPolicy>, LearnError>;
}

/// A learnt policy, with its potential, support, uncertainty and warnings.
pub trait LearntPolicy: Policy + Debug {
    /// The potential that the policy descends; none if the learner assumes none.
    fn potential(&self) -> Option<&dyn Potential> {
        None
    }

    /// How well the demonstrations support a state, (n): 1 amid them, 0 where the action is a mere default.
    ///
    /// Each learner has its own measure: LWPR the largest activation of a receptive field that takes part, a Gaussian
    /// process 1 − posterior / prior variance.
    fn support(&self, state: DVectorView<'_, f64>) -> f64;

    /// The support of each of some states, (n, N), in their order: to rounding that of one after the other. A learner for which many
    /// cost less together than alone says how.
    fn supports(&self, states: &DMatrix<f64>) -> Vec<f64> {
        states.column_iter().map(|state| self.support(state)).collect()
    }

    /// Writes the standard deviation of every component of the action, (n), into `deviation`, in units of the state per
    /// second, and returns true; returns false and writes nothing if the learner has no estimate.
    fn action_sd_into(&self, _state: DVectorView<'_, f64>, _deviation: DVectorViewMut<'_, f64>) -> bool {
        false
    }

    /// The standard deviations of every component of the action, (n, N), at each of some states, (n, N), likewise; none if the learner
    /// has no estimate.
    fn action_sds(&self, states: &DMatrix<f64>) -> Option<DMatrix<f64>> {
        let mut deviations = DMatrix::zeros(states.nrows(), states.ncols());
        let each = states.column_iter().zip(deviations.column_iter_mut());
        let known = each.fold(true, |known, (state, deviation)| self.action_sd_into(state, deviation) && known);
        known.then_some(deviations)
    }

    /// The trajectories used for learning, ascending; none if all were.
    fn kept(&self) -> Option<&[usize]> {
        None
    }

    /// Warnings about the policy, one sentence each.
    fn warnings(&self) -> Vec<String> {
        Vec::new()
    }
}
