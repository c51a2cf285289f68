use lwpr::{Lwpr, LwprParams};
use motion::{Demonstrations, Policy, Trajectory};
use nalgebra::{DMatrix, DVector, DVectorView, DVectorViewMut};
use rand::Rng;

use crate::centred_model::{CentredModel, Training};
use crate::{AlignError, SampleIndex};

/// Direct policy learning, the naive baseline: regression of the observed velocities on the states, as if nothing had
/// been constrained.
///
/// It learns from all trajectories: the recorded velocities, or else u_i = (x_{i+1} − x_i) / δt for all samples but the
/// last.
#[derive(Debug, Clone, PartialEq)]
pub struct DirectPolicyLearning {
    /// Parameters of LWPR; `norm_out` is replaced by the standard deviations of the velocities.
    pub params: LwprParams,
    /// How often all samples are learnt, each time in a fresh random order; 10 by default.
    pub passes: usize,
    /// Receptive fields take part in a prediction if their activation exceeds this; in [0, 1), 1e-3 by default.
    pub cutoff: f64,
}

impl Default for DirectPolicyLearning {
    fn default() -> Self {
        DirectPolicyLearning { params: LwprParams::default(), passes: 10, cutoff: 1e-3 }
    }
}

impl DirectPolicyLearning {
    /// Learns from all samples.
    ///
    /// # Errors
    /// [`AlignError::Parameter`] or [`AlignError::Lwpr`] for parameters out of range.
    pub fn learn<R: Rng + ?Sized>(
        &self,
        demonstrations: &Demonstrations,
        rng: &mut R,
    ) -> Result<DirectPolicy, AlignError> {
        self.learn_without(&[], demonstrations, rng)
    }

    /// Learns from all samples but those held out.
    ///
    /// # Errors
    /// As [`DirectPolicyLearning::learn`], and [`AlignError::NoSamples`] if none is left.
    pub fn learn_without<R: Rng + ?Sized>(
        &self,
        held_out: &[SampleIndex],
        demonstrations: &Demonstrations,
        rng: &mut R,
    ) -> Result<DirectPolicy, AlignError> {
        let (states, velocities) = observed(demonstrations, held_out);
        let training = Training { params: &self.params, passes: self.passes, cutoff: self.cutoff };
        CentredModel::fit(training, &states, velocities, rng).map(|learnt| DirectPolicy { learnt })
    }
}

/// States (n, M) and velocities (n, M) of all samples that have one and are not held out.
fn observed(demonstrations: &Demonstrations, held_out: &[SampleIndex]) -> (DMatrix<f64>, DMatrix<f64>) {
    let mut held_out = held_out.to_vec();
    held_out.sort_unstable();
    let mut states = Vec::new();
    let mut velocities = Vec::new();
    for (index, trajectory) in demonstrations.trajectories().iter().enumerate() {
        for (sample, velocity) in velocities_of(trajectory).column_iter().enumerate() {
            if held_out.binary_search(&SampleIndex { trajectory: index, sample }).is_err() {
                states.extend(trajectory.state(sample).iter());
                velocities.extend(velocity.iter());
            }
        }
    }
    let n = demonstrations.dim();
    let samples = states.len() / n;
    (DMatrix::from_vec(n, samples, states), DMatrix::from_vec(n, samples, velocities))
}

fn velocities_of(trajectory: &Trajectory) -> DMatrix<f64> {
    let x = trajectory.states();
    let steps = x.ncols() - 1;
    let differences = || (x.columns(1, steps) - x.columns(0, steps)) / trajectory.time_step();
    trajectory.velocities().cloned().unwrap_or_else(differences)
}

/// The policy that direct policy learning found.
///
/// Far from the data no receptive field takes part: the action is then the mean of the training velocities.
#[derive(Debug, Clone)]
pub struct DirectPolicy {
    learnt: CentredModel,
}

impl DirectPolicy {
    /// Whether receptive fields take part in the action at this state, (n), in every dimension.
    pub fn supports(&self, state: DVectorView<'_, f64>) -> bool {
        (0..self.dim()).all(|output| self.learnt.predictor.value(state, output).is_some())
    }

    /// The share of states (n, M), one column each, without support; 0 for no states.
    pub fn unsupported_share(&self, states: &DMatrix<f64>) -> f64 {
        let unsupported = states.column_iter().filter(|state| !self.supports(state.as_view())).count();
        unsupported as f64 / states.ncols().max(1) as f64
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
