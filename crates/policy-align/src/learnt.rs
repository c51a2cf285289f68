use align::PotentialPolicy;
use gp::{AutoFit, DirectFit, SlopeFit};
use motion::LearntPolicy;
use serde::{Deserialize, Serialize};

/// A learnt policy in its stored form, by its learner.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Learnt {
    /// Slope GP and direct GP, with the choice between them.
    Auto(Box<AutoFit>),
    /// Aligned potentials and LWPR.
    PolicyAlign(Box<PotentialPolicy>),
    /// The slope GP alone.
    Slope(Box<SlopeFit>),
    /// The direct GP alone.
    Direct(Box<DirectFit>),
}

impl Learnt {
    /// The policy, in the units in which it was learnt.
    pub fn policy(&self) -> &dyn LearntPolicy {
        match self {
            Learnt::Auto(policy) => policy.as_ref(),
            Learnt::PolicyAlign(policy) => policy.as_ref(),
            Learnt::Slope(policy) => policy.as_ref(),
            Learnt::Direct(policy) => policy.as_ref(),
        }
    }
}
