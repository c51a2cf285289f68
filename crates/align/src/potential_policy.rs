use motion::{LearntPolicy, NegativeGradient, Policy, Potential};
use nalgebra::{DVectorView, DVectorViewMut};

use crate::{AlignError, Aligned, GlobalPotential};

/// The policy π̂(x) = −∇f(x) of a potential f that was learnt from aligned demonstrations; the gradient is that of the
/// predictor itself.
///
/// Far from the data no receptive field takes part: the action is then zero.
#[derive(Debug, Clone)]
pub struct PotentialPolicy {
    descent: NegativeGradient<GlobalPotential>,
    kept: Vec<usize>,
    warnings: Vec<String>,
}

impl PotentialPolicy {
    pub(crate) fn new(potential: GlobalPotential, aligned: &Aligned) -> Self {
        PotentialPolicy {
            descent: NegativeGradient(potential),
            kept: aligned.kept().to_vec(),
            warnings: aligned.warnings().iter().map(ToString::to_string).collect(),
        }
    }

    /// The potential f (23).
    pub fn global_potential(&self) -> &GlobalPotential {
        &self.descent.0
    }

    /// The same policy, in which receptive fields take part as soon as their activation exceeds `cutoff`. Roll-outs
    /// that leave the data want a tiny one, 1e-9.
    ///
    /// # Errors
    /// [`AlignError::Parameter`] if `cutoff` is not at least 0 and less than 1.
    pub fn with_cutoff(&self, cutoff: f64) -> Result<Self, AlignError> {
        let descent = NegativeGradient(self.global_potential().with_cutoff(cutoff)?);
        Ok(PotentialPolicy { descent, ..self.clone() })
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

    /// The largest activation of a receptive field, or 0 where none exceeds the cutoff.
    fn support(&self, state: DVectorView<'_, f64>) -> f64 {
        self.global_potential().support(state)
    }

    fn kept(&self) -> Option<&[usize]> {
        Some(&self.kept)
    }

    fn warnings(&self) -> Vec<String> {
        self.warnings.clone()
    }
}
