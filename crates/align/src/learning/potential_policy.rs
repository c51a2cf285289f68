use motion::{Channel, LearntPolicy, NegativeGradient, Policy, Potential};
use nalgebra::{DVectorView, DVectorViewMut};
use serde::{Deserialize, Serialize};

use super::policy_record::{Format, PolicyRecord};
use super::regression::support;
use crate::{AlignError, GlobalPotential, Origin};

/// The policy π̂(x) = −∇f(x) of a potential f learnt from aligned demonstrations. The gradient is the exact derivative
/// of the predictor.
///
/// Far from the data no receptive field takes part; the action is then zero. The policy can be stored with serde; after
/// reading, its actions are the same to the last bit.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(try_from = "PolicyRecord", into = "PolicyRecord")]
pub struct PotentialPolicy {
    descent: NegativeGradient<GlobalPotential>,
    origin: Origin,
}

impl PotentialPolicy {
    pub(crate) fn new(potential: GlobalPotential, origin: Origin) -> Self {
        PotentialPolicy { descent: NegativeGradient(potential), origin }
    }

    /// The potential f (23).
    pub fn global_potential(&self) -> &GlobalPotential {
        &self.descent.0
    }

    /// Summary of the training data.
    pub fn origin(&self) -> &Origin {
        &self.origin
    }

    /// The same policy with another cutoff: receptive fields take part if their activation exceeds `cutoff`. Roll-outs
    /// that leave the data need a tiny one, 1e-9.
    ///
    /// # Errors
    /// [`AlignError::Lwpr`] if `cutoff` is not at least 0 and less than 1.
    pub fn with_cutoff(&self, cutoff: f64) -> Result<Self, AlignError> {
        let regression = self.global_potential().regression().with_cutoff(cutoff)?;
        Ok(Self::new(GlobalPotential::new(regression), self.origin.clone()))
    }

    /// The same policy with names and units of its dimensions, n of them or none.
    ///
    /// # Errors
    /// [`AlignError::Channels`] if their number differs from the dimension.
    pub fn with_channels(self, channels: Vec<Channel>) -> Result<Self, AlignError> {
        let origin = self.origin.with_channels(channels, self.descent.dim())?;
        Ok(PotentialPolicy { origin, ..self })
    }
}

impl Policy for PotentialPolicy {
    fn dim(&self) -> usize {
        self.descent.dim()
    }

    fn action_into(&self, state: DVectorView<'_, f64>, action: DVectorViewMut<'_, f64>) {
        self.descent.action_into(state, action);
    }
}

impl LearntPolicy for PotentialPolicy {
    fn potential(&self) -> Option<&dyn Potential> {
        Some(self.global_potential())
    }

    /// The largest activation of a receptive field, or 0 if none exceeds the cutoff.
    fn support(&self, state: DVectorView<'_, f64>) -> f64 {
        support(self.global_potential().regression(), state)
    }

    fn kept(&self) -> Option<&[usize]> {
        self.origin.kept.as_deref()
    }

    fn warnings(&self) -> Vec<String> {
        self.origin.warnings.clone()
    }
}

impl From<PotentialPolicy> for PolicyRecord {
    fn from(policy: PotentialPolicy) -> Self {
        PolicyRecord::new(Format::Potential, policy.origin(), policy.global_potential().regression())
    }
}

impl TryFrom<PolicyRecord> for PotentialPolicy {
    type Error = AlignError;

    fn try_from(record: PolicyRecord) -> Result<Self, AlignError> {
        let (origin, regression) = record.check(Format::Potential, |_| 1)?;
        Ok(PotentialPolicy::new(GlobalPotential::new(regression), origin))
    }
}
