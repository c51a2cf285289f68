use lwpr::StandardisedModel;
use motion::{Channel, LearntPolicy, Policy};
use nalgebra::{DVectorView, DVectorViewMut};
use serde::{Deserialize, Serialize};

use super::policy_record::{Format, PolicyRecord};
use super::regression::support;
use crate::{AlignError, Origin};

/// The policy of direct policy learning.
///
/// Far from the data no receptive field takes part: the action is then the mean of the training velocities. It can be
/// stored with serde; what is read back acts the same to the last bit.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(try_from = "PolicyRecord", into = "PolicyRecord")]
pub struct DirectPolicy {
    regression: StandardisedModel,
    origin: Origin,
}

impl DirectPolicy {
    /// Of a regression with as many outputs as inputs.
    pub(crate) fn new(regression: StandardisedModel, origin: Origin) -> Self {
        DirectPolicy { regression, origin }
    }

    /// The underlying regression: its mean is that of the training velocities, in units of the state per second.
    pub fn regression(&self) -> &StandardisedModel {
        &self.regression
    }

    /// Summary of its training data.
    pub fn origin(&self) -> &Origin {
        &self.origin
    }

    /// The same policy, of which receptive fields take part as soon as their activation exceeds `cutoff`.
    ///
    /// # Errors
    /// [`AlignError::Lwpr`] if `cutoff` is not at least 0 and less than 1.
    pub fn with_cutoff(&self, cutoff: f64) -> Result<Self, AlignError> {
        Ok(Self::new(self.regression.with_cutoff(cutoff)?, self.origin.clone()))
    }

    /// The same policy with names and units of its dimensions, n of them or none.
    ///
    /// # Errors
    /// [`AlignError::Channels`] if there is not one for each dimension.
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
    /// The largest activation of a receptive field, in the dimension that has least of it, or 0 where no field exceeds
    /// the cutoff in some dimension.
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
