//! Ways to learn a policy, each one entry: experiments score a list of them on the same recordings.

use std::fmt::Debug;

use align::{Aligned, DirectPolicyLearning, LwprRegressor, Samples};
use motion::{Policy, Potential};
use rand_chacha::ChaCha8Rng;

/// What every learner is given of one data set: the observed movements, aligned, and which samples it must not learn
/// from.
pub(crate) struct Lesson<'a> {
    /// The demonstrations, for those who align potentials as for those who do not.
    pub(crate) aligned: &'a Aligned,
    /// Samples kept for testing.
    pub(crate) held_out: &'a Samples<'a>,
}

/// What a learner returns.
pub(crate) struct Learnt {
    /// The policy.
    pub(crate) policy: Box<dyn Policy>,
    /// The potential it descends, if it is known to have one.
    pub(crate) potential: Option<Box<dyn Potential>>,
    /// Share of the samples kept for testing where it has nothing to go by.
    pub(crate) unsupported: f64,
}

/// A way to learn. `Debug` names all its parameters: they are part of the records' keys.
pub(crate) trait Learner: Debug + Send + Sync {
    /// Learns a policy.
    fn learn(&self, lesson: &Lesson<'_>, rng: &mut ChaCha8Rng) -> anyhow::Result<Learnt>;
}

/// Regression on aligned potentials: the paper's method.
impl Learner for LwprRegressor {
    fn learn(&self, lesson: &Lesson<'_>, rng: &mut ChaCha8Rng) -> anyhow::Result<Learnt> {
        let training = lesson.aligned.samples().without(lesson.held_out.indices());
        let learnt = lesson.aligned.regress(self, &training, rng)?;
        let unsupported = learnt.potential().unsupported_share(&lesson.held_out.states());
        let potential = Box::new(learnt.potential().clone());
        Ok(Learnt { policy: Box::new(learnt.into_policy()), potential: Some(potential), unsupported })
    }
}

/// The naive baseline.
impl Learner for DirectPolicyLearning {
    fn learn(&self, lesson: &Lesson<'_>, rng: &mut ChaCha8Rng) -> anyhow::Result<Learnt> {
        let policy = self.learn_without(lesson.held_out.indices(), lesson.aligned.demonstrations(), rng)?;
        let unsupported = policy.unsupported_share(&lesson.held_out.states());
        Ok(Learnt { policy: Box::new(policy), potential: None, unsupported })
    }
}
