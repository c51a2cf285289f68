use std::fmt::Debug;

use nalgebra::{DMatrix, DMatrixView, DVector, DVectorView, DVectorViewMut};
use rand::Rng;

use crate::{Demonstrations, Policy, Potential, SampleIndex};

/// Reasons why a learner failed. Each learner has its own error type, whose message contains the fault, its place and a remedy.
pub type LearnError = Box<dyn std::error::Error + Send + Sync>;

/// A method that learns a policy from demonstrations.
///
/// A learner is a plain set of parameters. `Debug` prints all of them: equal texts mean equal learners.
pub trait Learner: Debug + Send + Sync {
    /// Learns from all samples except the held-out ones, which may be in any order. The same generator gives the same bits with any number
    /// of threads.
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

/// How certain a policy is of its actions at N states.
#[derive(Debug, Clone, PartialEq)]
pub struct Certainty {
    /// [`LearntPolicy::support`], (N).
    pub support: Vec<f64>,
    /// Standard deviations of every component of the action, (n, N), in units of the state per second; `None` if the learner has no
    /// estimate.
    pub deviations: Option<DMatrix<f64>>,
}

/// A learnt policy, with its potential, support, uncertainty and warnings.
pub trait LearntPolicy: Policy + Debug {
    /// The potential that the policy descends; `None` if the learner assumes none.
    fn potential(&self) -> Option<&dyn Potential> {
        None
    }

    /// How well the demonstrations support a state, (n): 1 close to them, 0 where the action is only a default.
    ///
    /// Each learner has its own measure: LWPR the largest activation of a contributing receptive field, a Gaussian process 1 − posterior /
    /// prior variance.
    fn support(&self, state: DVectorView<'_, f64>) -> f64;

    /// Writes the standard deviation of every component of the action, (n), into `deviation`, in units of the state per
    /// second, and returns true; returns false and writes nothing if the learner has no estimate.
    fn action_sd_into(&self, _state: DVectorView<'_, f64>, _deviation: DVectorViewMut<'_, f64>) -> bool {
        false
    }

    /// [`support`](Self::support) and [`action_sd_into`](Self::action_sd_into) at many states, (n, N), with the same numbers as for single
    /// states. For a Gaussian process this is several times faster.
    fn certainty(&self, states: DMatrixView<'_, f64>) -> Certainty {
        let support = states.column_iter().map(|state| self.support(state)).collect();
        let (mut deviations, mut deviation) = (DMatrix::zeros(self.dim(), states.ncols()), DVector::zeros(self.dim()));
        let mut known = states.ncols() > 0;
        for (state, mut place) in states.column_iter().zip(deviations.column_iter_mut()) {
            known = known && self.action_sd_into(state, deviation.as_view_mut());
            place.copy_from(&deviation);
        }
        Certainty { support, deviations: known.then_some(deviations) }
    }

    /// Whether [`support`](Self::support) is at least `least` at each of these states (n, N), as in [`certainty`](Self::certainty). For a
    /// Gaussian process this is several times faster: a state supported by some of its rows is supported by all.
    fn supported(&self, states: DMatrixView<'_, f64>, least: f64) -> Vec<bool> {
        self.certainty(states).support.into_iter().map(|support| support >= least).collect()
    }

    /// The trajectories used for learning, ascending; `None` if all were.
    fn kept(&self) -> Option<&[usize]> {
        None
    }

    /// Warnings about the policy, one sentence each.
    fn warnings(&self) -> Vec<String> {
        Vec::new()
    }
}
