use lwpr::Lwpr;
use motion::{LearntPolicy, Policy};
use nalgebra::{DVector, DVectorView, DVectorViewMut};

use crate::AlignError;
use crate::centred_model::CentredModel;

/// The policy that direct policy learning found.
///
/// Far from the data no receptive field takes part: the action is then the mean of the training velocities.
#[derive(Debug, Clone)]
pub struct DirectPolicy {
    learnt: CentredModel,
}

impl DirectPolicy {
    pub(crate) fn new(learnt: CentredModel) -> Self {
        DirectPolicy { learnt }
    }

    /// The same policy, in which receptive fields take part as soon as their activation exceeds `cutoff`.
    ///
    /// # Errors
    /// [`AlignError::Parameter`] if `cutoff` is not at least 0 and less than 1.
    pub fn with_cutoff(&self, cutoff: f64) -> Result<Self, AlignError> {
        Ok(DirectPolicy { learnt: self.learnt.with_cutoff(cutoff)? })
    }

    /// The mean of the training velocities, (n), in units of the state per second.
    pub fn mean(&self) -> &DVector<f64> {
        &self.learnt.mean
    }

    /// The regression beneath, which learnt velocities − mean.
    pub fn model(&self) -> &Lwpr {
        &self.learnt.model
    }
}

impl Policy for DirectPolicy {
    fn dim(&self) -> usize {
        self.learnt.model.n_in()
    }

    fn action_into(&self, state: DVectorView<'_, f64>, mut action: DVectorViewMut<'_, f64>) {
        assert_eq!(state.len(), self.dim(), "a state has as many dimensions as the policy");
        assert_eq!(action.len(), self.dim(), "an action has as many dimensions as the policy");
        for output in 0..self.dim() {
            action[output] = self.learnt.mean[output] + self.learnt.predictor.value(state, output).unwrap_or(0.0);
        }
    }
}

impl LearntPolicy for DirectPolicy {
    /// The largest activation of a receptive field, in the dimension that has least of it, or 0 where no field exceeds
    /// the cutoff in some dimension.
    fn support(&self, state: DVectorView<'_, f64>) -> f64 {
        self.learnt.support(state)
    }
}
