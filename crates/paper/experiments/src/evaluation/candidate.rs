//! Learners that an experiment evaluates.

use align::{Aligned, LwprRegressor};
use motion::{Learner, LearntPolicy, SampleIndex};
use rand_chacha::ChaCha8Rng;
use serde::Serialize;
use serde_json::Value;

/// One of the learners that an experiment scores.
#[derive(Serialize)]
pub(crate) enum Candidate {
    /// The paper's method: regression on the potentials that the evaluation has already aligned. The result is
    /// identical to the last bit to that of [`align::PotentialPolicyLearning`], without a second alignment.
    PolicyAlign(LwprRegressor),
    /// A learner that starts from the demonstrations.
    Other {
        /// The learner.
        #[serde(skip)]
        learner: Box<dyn Learner>,
        /// All its parameters, by name.
        parameters: Value,
    },
}

impl Candidate {
    /// A learner that starts from the demonstrations.
    pub(crate) fn other<L: Learner + Serialize + 'static>(learner: L) -> anyhow::Result<Candidate> {
        Ok(Candidate::Other { parameters: serde_json::to_value(&learner)?, learner: Box::new(learner) })
    }

    /// Learns from all samples except the held-out ones.
    pub(crate) fn learn(
        &self,
        aligned: &Aligned,
        held_out: &[SampleIndex],
        rng: &mut ChaCha8Rng,
    ) -> anyhow::Result<Box<dyn LearntPolicy>> {
        match self {
            Candidate::PolicyAlign(regressor) => Ok(Box::new(aligned.learn_without(held_out, regressor, rng)?)),
            Candidate::Other { learner, .. } => {
                learner.learn(aligned.demonstrations(), held_out, rng).map_err(anyhow::Error::from_boxed)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use align::{PolicyAlign, PotentialPolicyLearning};
    use demo_gen::{ToySystem, demonstrations};

    use super::*;
    use crate::seed::generator;

    /// Learning from aligned potentials gives the same result as aligning again.
    #[test]
    fn potentials_that_are_aligned_need_no_second_alignment() {
        let system = ToySystem { n_trajectories: 12, ..ToySystem::default() };
        let demonstrations = demonstrations(&system.record(&mut generator(1, 0, 0)).unwrap()).unwrap();
        let regressor = LwprRegressor { passes: 2, ..LwprRegressor::default() };
        let align = PolicyAlign::default();
        let aligned = align.align(&demonstrations).unwrap();
        let held_out = demonstrations.hold_out_samples(aligned.kept(), 0.1, &mut generator(1, 0, 1)).unwrap();
        let whole = PotentialPolicyLearning { align, regressor: regressor.clone() };
        let [short, long] = [Candidate::PolicyAlign(regressor), Candidate::other(whole).unwrap()]
            .map(|candidate| candidate.learn(&aligned, &held_out, &mut generator(1, 0, 2)).unwrap());
        for trajectory in demonstrations.trajectories() {
            for state in trajectory.states().column_iter() {
                assert_eq!(short.action(state), long.action(state));
            }
        }
        assert_eq!(short.kept(), long.kept());
    }
}
