//! Ways to learn a policy, each one entry: experiments score a list of them on the same recordings.

use std::fmt::Debug;

use align::{Aligned, DirectPolicyLearning, LwprRegressor};
use motion::{LearntPolicy, Policy, Potential, SampleIndex};
use nalgebra::DVectorView;
use rand_chacha::ChaCha8Rng;

/// What every learner is given of one data set: the observed movements, aligned, and which samples it must not learn
/// from.
pub(crate) struct Lesson<'a> {
    /// The demonstrations, for those who align potentials as for those who do not.
    pub(crate) aligned: &'a Aligned,
    /// Samples kept for testing.
    pub(crate) held_out: &'a [SampleIndex],
}

impl Lesson<'_> {
    fn unsupported_share(&self, policy: &dyn LearntPolicy) -> f64 {
        let trajectories = self.aligned.demonstrations().trajectories();
        let state = |at: &SampleIndex| -> DVectorView<'_, f64> { trajectories[at.trajectory].state(at.sample) };
        let unsupported = self.held_out.iter().filter(|at| policy.support(state(at)) == 0.0).count();
        unsupported as f64 / self.held_out.len().max(1) as f64
    }
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
        let policy = lesson.aligned.learn_without(lesson.held_out, self, rng)?;
        let unsupported = lesson.unsupported_share(&policy);
        let potential = Box::new(policy.global_potential().clone());
        Ok(Learnt { policy: Box::new(policy), potential: Some(potential), unsupported })
    }
}

/// The naive baseline.
impl Learner for DirectPolicyLearning {
    fn learn(&self, lesson: &Lesson<'_>, rng: &mut ChaCha8Rng) -> anyhow::Result<Learnt> {
        let policy = self.learn_policy(lesson.aligned.demonstrations(), lesson.held_out, rng)?;
        let unsupported = lesson.unsupported_share(&policy);
        Ok(Learnt { policy: Box::new(policy), potential: None, unsupported })
    }
}
