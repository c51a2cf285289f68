use std::cell::RefCell;

use nalgebra::{DMatrix, DVector, DVectorView};
use serde::{Deserialize, Serialize};

use crate::GpError;

/// Maximum dimension of a state that is stored on the stack.
pub(crate) const FEW: usize = 32;

thread_local! {
    static MANY: RefCell<Vec<f64>> = const { RefCell::new(Vec::new()) };
}

/// Scaled coordinates z = (x − μ)/S. One S for all axes, because a gradient field remains one only under a common
/// scale.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Scaling {
    /// μ, (n).
    pub(crate) mean: Vec<f64>,
    /// S: root of the mean over axes of their variances.
    pub(crate) scale: f64,
}

impl Scaling {
    /// The scaling of states (n, M).
    pub(crate) fn of(states: &DMatrix<f64>) -> Result<Self, GpError> {
        let count = states.ncols() as f64;
        let mean: Vec<f64> = states.row_iter().map(|axis| axis.iter().sum::<f64>() / count).collect();
        let variance =
            |(axis, mean): (usize, &f64)| states.row(axis).iter().map(|x| (x - mean).powi(2)).sum::<f64>() / count;
        let variances: f64 = mean.iter().enumerate().map(variance).sum();
        let scale = (variances / mean.len() as f64).sqrt();
        // The mean of equal numbers may differ from them by rounding.
        let furthest =
            states.row_iter().zip(&mean).map(|(axis, mean)| axis.add_scalar(-mean).amax()).fold(0.0, f64::max);
        if furthest <= 1e-14 * states.amax() {
            return Err(GpError::OneState);
        }
        if !(scale > 1e-150 && scale < 1e150) {
            return Err(GpError::Overflow { what: "distance" });
        }
        Ok(Scaling { mean, scale })
    }

    /// z of each state, (n, M).
    pub(crate) fn apply(&self, states: &DMatrix<f64>) -> DMatrix<f64> {
        DMatrix::from_fn(states.nrows(), states.ncols(), |k, row| (states[(k, row)] - self.mean[k]) / self.scale)
    }

    /// z of one state, (n).
    pub(crate) fn of_state(&self, state: DVectorView<'_, f64>) -> DVector<f64> {
        DVector::from_fn(state.len(), |k, _| self.coordinate(k, state[k]))
    }

    /// Evaluates at z of one state, (n). Does not allocate for up to [`FEW`] dimensions; otherwise allocates once per
    /// thread.
    pub(crate) fn with_coordinates<T>(&self, state: &[f64], evaluate: impl FnOnce(&[f64]) -> T) -> T {
        let into = |z: &mut [f64]| {
            for (k, (z, &x)) in z.iter_mut().zip(state).enumerate() {
                *z = self.coordinate(k, x);
            }
        };
        if state.len() <= FEW {
            let mut few = [0.0; FEW];
            into(&mut few[..state.len()]);
            return evaluate(&few[..state.len()]);
        }
        MANY.with_borrow_mut(|many| {
            many.resize(state.len(), 0.0);
            into(many);
            evaluate(many)
        })
    }

    /// z_k.
    pub(crate) fn coordinate(&self, axis: usize, value: f64) -> f64 {
        (value - self.mean[axis]) / self.scale
    }
}
