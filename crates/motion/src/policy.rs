use nalgebra::{DMatrix, DMatrixView, DVector, DVectorView, DVectorViewMut};

/// An autonomous movement policy u = π(x) (1): the desired velocity at a state.
///
/// Methods panic if a vector's length differs from [`Policy::dim`].
pub trait Policy: Send + Sync {
    /// Dimension n of state and action.
    fn dim(&self) -> usize;

    /// Writes π(x), (n), into `action`, in units of the state per second. Does not allocate.
    fn action_into(&self, state: DVectorView<'_, f64>, action: DVectorViewMut<'_, f64>);

    /// π(x), (n), in units of the state per second.
    fn action(&self, state: DVectorView<'_, f64>) -> DVector<f64> {
        let mut action = DVector::zeros(self.dim());
        self.action_into(state, action.as_view_mut());
        action
    }

    /// π(x) at many states, (n, N), one per column, in units of the state per second, with the same numbers as for
    /// single states.
    fn actions(&self, states: DMatrixView<'_, f64>) -> DMatrix<f64> {
        let (mut actions, mut action) = (DMatrix::zeros(self.dim(), states.ncols()), DVector::zeros(self.dim()));
        for (state, mut place) in states.column_iter().zip(actions.column_iter_mut()) {
            self.action_into(state, action.as_view_mut());
            place.copy_from(&action);
        }
        actions
    }
}

/// A scalar potential φ(x) whose negative gradient is a policy (4).
///
/// Methods panic if a vector's length differs from [`Potential::dim`].
pub trait Potential: Send + Sync {
    /// Dimension n of the state.
    fn dim(&self) -> usize;

    /// φ(x), in units of the state squared per second.
    fn value(&self, state: DVectorView<'_, f64>) -> f64;

    /// Writes ∇φ(x), (n), into `gradient`, in units of the state per second. Does not allocate.
    fn gradient_into(&self, state: DVectorView<'_, f64>, gradient: DVectorViewMut<'_, f64>);

    /// ∇φ(x), (n), in units of the state per second.
    fn gradient(&self, state: DVectorView<'_, f64>) -> DVector<f64> {
        let mut gradient = DVector::zeros(self.dim());
        self.gradient_into(state, gradient.as_view_mut());
        gradient
    }
}

/// The policy π(x) = −∇φ(x) of a potential (4).
#[derive(Debug, Clone, PartialEq)]
pub struct NegativeGradient<P>(pub P);

impl<P: Potential> Policy for NegativeGradient<P> {
    fn dim(&self) -> usize {
        self.0.dim()
    }

    fn action_into(&self, state: DVectorView<'_, f64>, mut action: DVectorViewMut<'_, f64>) {
        self.0.gradient_into(state, action.as_view_mut());
        action.neg_mut();
    }
}

impl<P: Policy + ?Sized> Policy for &P {
    fn dim(&self) -> usize {
        (**self).dim()
    }

    fn action_into(&self, state: DVectorView<'_, f64>, action: DVectorViewMut<'_, f64>) {
        (**self).action_into(state, action);
    }

    fn actions(&self, states: DMatrixView<'_, f64>) -> DMatrix<f64> {
        (**self).actions(states)
    }
}

impl<P: Potential + ?Sized> Potential for &P {
    fn dim(&self) -> usize {
        (**self).dim()
    }

    fn value(&self, state: DVectorView<'_, f64>) -> f64 {
        (**self).value(state)
    }

    fn gradient_into(&self, state: DVectorView<'_, f64>, gradient: DVectorViewMut<'_, f64>) {
        (**self).gradient_into(state, gradient);
    }
}
