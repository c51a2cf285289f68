use lwpr::Lwpr;
use motion::Potential;
use nalgebra::{DVectorView, DVectorViewMut};

use crate::AlignError;
use crate::centred_model::CentredModel;

/// The potential f (23) that LWPR learnt from levelled samples.
///
/// Far from the data no receptive field takes part: the value is then the mean of the training values, and the gradient
/// zero.
#[derive(Debug, Clone)]
pub struct GlobalPotential {
    learnt: CentredModel,
}

impl GlobalPotential {
    pub(crate) fn new(learnt: CentredModel) -> Self {
        GlobalPotential { learnt }
    }

    /// The largest activation of a receptive field at this state, (n), or 0 where none exceeds the cutoff.
    pub fn support(&self, state: DVectorView<'_, f64>) -> f64 {
        self.learnt.support(state)
    }

    /// The same potential, of which receptive fields take part as soon as their activation exceeds `cutoff`. Roll-outs
    /// that leave the data want a tiny one, 1e-9.
    ///
    /// # Errors
    /// [`AlignError::Parameter`] if `cutoff` is not at least 0 and less than 1.
    pub fn with_cutoff(&self, cutoff: f64) -> Result<Self, AlignError> {
        self.learnt.with_cutoff(cutoff).map(GlobalPotential::new)
    }

    /// The mean of the training values, in units of the state squared per second.
    pub fn mean(&self) -> f64 {
        self.learnt.mean[0]
    }

    /// The regression beneath, which learnt value − mean.
    pub fn model(&self) -> &Lwpr {
        &self.learnt.model
    }
}

impl Potential for GlobalPotential {
    fn dim(&self) -> usize {
        self.learnt.model.n_in()
    }

    fn value(&self, state: DVectorView<'_, f64>) -> f64 {
        assert_eq!(state.len(), self.dim(), "a state has as many dimensions as the potential");
        self.mean() + self.learnt.predictor.value(state, 0).unwrap_or(0.0)
    }

    fn gradient_into(&self, state: DVectorView<'_, f64>, mut gradient: DVectorViewMut<'_, f64>) {
        assert_eq!(state.len(), self.dim(), "a state has as many dimensions as the potential");
        if self.learnt.predictor.value_and_gradient_into(state, 0, gradient.as_view_mut()).is_none() {
            gradient.fill(0.0);
        }
    }
}
