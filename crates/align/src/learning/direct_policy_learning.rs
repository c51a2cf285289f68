use motion::{Demonstrations, LearnError, Learner, LearntPolicy, SampleIndex, SampleSet, Trajectory};
use nalgebra::DMatrix;
use rand::Rng;
use serde::{Deserialize, Serialize};

use crate::checks::one_context;
use crate::{AlignError, DirectPolicy, LwprRegressor, Origin};

/// Direct policy learning, the naive baseline: regression of the observed velocities on the states, ignoring constraints.
///
/// Learns from all trajectories: from the recorded velocities, or else from u_i = (x_{i+1} − x_i) / δt for all samples
/// except the last.
///
/// Stored in the form of its regressor.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct DirectPolicyLearning {
    /// The regression of the velocities.
    pub regressor: LwprRegressor,
}

impl DirectPolicyLearning {
    /// Learns from all samples but those held out.
    ///
    /// # Errors
    /// [`AlignError::Lwpr`] for parameters out of range, [`AlignError::NoSamples`] if no sample remains.
    pub fn learn_policy(
        &self,
        demonstrations: &Demonstrations,
        held_out: &[SampleIndex],
        rng: &mut dyn Rng,
    ) -> Result<DirectPolicy, AlignError> {
        one_context(demonstrations)?;
        let (states, velocities) = observed(demonstrations, held_out);
        let regression = self.regressor.regression(&states, &velocities, rng)?;
        Ok(DirectPolicy::new(regression, Origin::new(demonstrations)))
    }
}

impl Learner for DirectPolicyLearning {
    fn learn(
        &self,
        demonstrations: &Demonstrations,
        held_out: &[SampleIndex],
        rng: &mut dyn Rng,
    ) -> Result<Box<dyn LearntPolicy>, LearnError> {
        Ok(Box::new(self.learn_policy(demonstrations, held_out, rng)?))
    }
}

/// States (n, M) and velocities (n, M) of all samples that have a velocity and are not held out.
fn observed(demonstrations: &Demonstrations, held_out: &[SampleIndex]) -> (DMatrix<f64>, DMatrix<f64>) {
    let held_out = SampleSet::of(held_out);
    let mut states = Vec::new();
    let mut velocities = Vec::new();
    for (index, trajectory) in demonstrations.trajectories().iter().enumerate() {
        for (sample, velocity) in velocities_of(trajectory).column_iter().enumerate() {
            if !held_out.contains(SampleIndex { trajectory: index, sample }) {
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
    trajectory.velocities().cloned().unwrap_or_else(|| trajectory.step_velocities())
}
