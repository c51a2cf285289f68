use lwpr::StandardisedModel;
use motion::{Channel, LearntPolicy, Policy};
use nalgebra::{DVectorView, DVectorViewMut};
use serde::{Deserialize, Serialize};

use super::policy_record::{Format, PolicyRecord};
use super::regression::support;
use crate::{AlignError, Origin};

/// The policy of direct policy learning.
///
/// Far from the data no receptive field takes part; the action is then the mean of the training velocities. The policy
/// can be stored with serde; after reading, its actions are the same to the last bit.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(try_from = "PolicyRecord", into = "PolicyRecord")]
pub struct DirectPolicy {
    regression: StandardisedModel,
    origin: Origin,
}

impl DirectPolicy {
    /// From a regression with as many outputs as inputs.
    pub(crate) fn new(regression: StandardisedModel, origin: Origin) -> Self {
        DirectPolicy { regression, origin }
    }

    /// The underlying regression. Its mean is that of the training velocities, in units of the state per second.
    pub fn regression(&self) -> &StandardisedModel {
        &self.regression
    }

    /// Summary of the training data.
    pub fn origin(&self) -> &Origin {
        &self.origin
    }

    /// The same policy with another cutoff: receptive fields take part if their activation exceeds `cutoff`.
    ///
    /// # Errors
    /// [`AlignError::Lwpr`] if `cutoff` is not at least 0 and less than 1.
    pub fn with_cutoff(&self, cutoff: f64) -> Result<Self, AlignError> {
        Ok(Self::new(self.regression.with_cutoff(cutoff)?, self.origin.clone()))
    }

    /// The same policy with names and units of its dimensions, n of them or none.
    ///
    /// # Errors
    /// [`AlignError::Channels`] if their number differs from the dimension.
    pub fn with_channels(self, channels: Vec<Channel>) -> Result<Self, AlignError> {
        let origin = self.origin.with_channels(channels, self.regression.n_in())?;
        Ok(DirectPolicy { origin, ..self })
    }
}

impl Policy for DirectPolicy {
    fn dim(&self) -> usize {
        self.regression.n_in()
    }

    fn action_into(&self, state: DVectorView<'_, f64>, mut action: DVectorViewMut<'_, f64>) {
        assert_eq!(state.len(), self.dim(), "a state has as many dimensions as the policy");
        assert_eq!(action.len(), self.dim(), "an action has as many dimensions as the policy");
        for output in 0..self.dim() {
            action[output] = self.regression.value(state, output);
        }
    }
}

impl LearntPolicy for DirectPolicy {
    /// The largest activation of a receptive field, in the dimension where it is smallest; 0 if in some dimension no
    /// field exceeds the cutoff.
    fn support(&self, state: DVectorView<'_, f64>) -> f64 {
        support(&self.regression, state)
    }
}

impl From<DirectPolicy> for PolicyRecord {
    fn from(policy: DirectPolicy) -> Self {
        PolicyRecord::new(Format::Direct, policy.origin(), policy.regression())
    }
}

impl TryFrom<PolicyRecord> for DirectPolicy {
    type Error = AlignError;

    fn try_from(record: PolicyRecord) -> Result<Self, AlignError> {
        let (origin, regression) = record.check(Format::Direct, |dim| dim)?;
        Ok(DirectPolicy::new(regression, origin))
    }
}
