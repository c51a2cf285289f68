use std::sync::Arc;

use motion::{Policy, Potential};
use nalgebra::{DMatrix, DMatrixView, DVectorView, DVectorViewMut};

use crate::dimension::require;
use crate::slope::expansion::Expansion;

/// π̂ of (S7), a function of a state followed by its context, along which it is 0. Cheap to clone.
#[derive(Debug, Clone, PartialEq)]
pub struct SlopePolicy {
    pub(crate) expansion: Arc<Expansion>,
}

/// φ̂ of (S7), whose negative gradient is π̂. Only its differences within one context are meaningful; along the context its
/// gradient counts as 0. Cheap to clone.
#[derive(Debug, Clone, PartialEq)]
pub struct SlopePotential {
    pub(crate) expansion: Arc<Expansion>,
}

impl Policy for SlopePolicy {
    fn dim(&self) -> usize {
        self.expansion.dim()
    }

    fn action_into(&self, state: DVectorView<'_, f64>, mut action: DVectorViewMut<'_, f64>) {
        require(self.dim(), &[state.len(), action.len()]);
        let (moving, still) = action.as_mut_slice().split_at_mut(self.expansion.moving());
        self.expansion.action_into(state.as_slice(), moving);
        still.fill(0.0);
    }

    fn actions(&self, states: DMatrixView<'_, f64>) -> DMatrix<f64> {
        require(self.dim(), &[states.nrows()]);
        self.expansion.actions(states).resize_vertically(self.dim(), 0.0)
    }
}

impl Potential for SlopePotential {
    fn dim(&self) -> usize {
        self.expansion.dim()
    }

    fn value(&self, state: DVectorView<'_, f64>) -> f64 {
        require(self.dim(), &[state.len()]);
        self.expansion.potential(state.as_slice())
    }

    fn gradient_into(&self, state: DVectorView<'_, f64>, mut gradient: DVectorViewMut<'_, f64>) {
        require(self.dim(), &[state.len(), gradient.len()]);
        let (moving, still) = gradient.as_mut_slice().split_at_mut(self.expansion.moving());
        self.expansion.action_into(state.as_slice(), moving);
        still.fill(0.0);
        gradient.neg_mut();
    }
}
