use motion::{Demonstrations, LearnError, Learner, LearntPolicy, SampleIndex};
use rand::Rng;
use serde::{Deserialize, Serialize};

use crate::{AlignError, LwprRegressor, PolicyAlign, PotentialPolicy};

/// The complete Algorithm 1 of the paper: aligns the demonstrations, learns one potential and descends
/// it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PotentialPolicyLearning {
    /// The alignment of the potentials along trajectories.
    pub align: PolicyAlign,
    /// The regression of the global potential.
    pub regressor: LwprRegressor,
}

impl PotentialPolicyLearning {
    /// Aligns all samples, and learns from those that are kept and not held out.
    ///
    /// To draw held-out samples from the kept trajectories, align first and continue with
    /// [`Aligned::learn_without`](crate::Aligned::learn_without), which gives the same policy to the
    /// last bit.
    ///
    /// # Errors
    /// As [`PolicyAlign::align`] and [`Aligned::learn_without`](crate::Aligned::learn_without).
    pub fn learn_policy(
        &self,
        demonstrations: &Demonstrations,
        held_out: &[SampleIndex],
        rng: &mut dyn Rng,
    ) -> Result<PotentialPolicy, AlignError> {
        self.align.align(demonstrations)?.learn_without(held_out, &self.regressor, rng)
    }
}

impl Learner for PotentialPolicyLearning {
    fn learn(
        &self,
        demonstrations: &Demonstrations,
        held_out: &[SampleIndex],
        rng: &mut dyn Rng,
    ) -> Result<Box<dyn LearntPolicy>, LearnError> {
        Ok(Box::new(self.learn_policy(demonstrations, held_out, rng)?))
    }
}
