use lwpr::StandardisedModel;
use motion::Potential;
use nalgebra::{DVectorView, DVectorViewMut};

/// The potential f (23) that LWPR learnt from aligned samples.
///
/// Far from the data no receptive field takes part; the value is then the mean of the training values, and the gradient
/// is zero.
#[derive(Debug, Clone)]
pub struct GlobalPotential {
    regression: StandardisedModel,
}

impl GlobalPotential {
    pub(crate) fn new(regression: StandardisedModel) -> Self {
        GlobalPotential { regression }
    }

    /// The underlying regression. Its mean and its spread (`norm_out`) are those of the training values.
    pub fn regression(&self) -> &StandardisedModel {
        &self.regression
    }
}

impl Potential for GlobalPotential {
    fn dim(&self) -> usize {
        self.regression.n_in()
    }

    fn value(&self, state: DVectorView<'_, f64>) -> f64 {
        assert_eq!(state.len(), self.dim(), "a state has as many dimensions as the potential");
        self.regression.value(state, 0)
    }

    fn gradient_into(&self, state: DVectorView<'_, f64>, gradient: DVectorViewMut<'_, f64>) {
        assert_eq!(state.len(), self.dim(), "a state has as many dimensions as the potential");
        self.regression.gradient_into(state, 0, gradient);
    }
}
