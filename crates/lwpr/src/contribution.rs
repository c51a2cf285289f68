//! The fields that answer a query, one by one: for full metrics, confidence and second derivatives.

use nalgebra::{DMatrix, DMatrixView, DVector};

use crate::Kernel;
use crate::kernel::Activation;
use crate::local_model::{Affine, LocalModel};

/// A field in reach of a query, in normalised units.
pub(crate) struct Contribution<'a> {
    pub(crate) activation: Activation<f64>,
    /// D(x − c), half the gradient of q.
    pub(crate) v: DVector<f64>,
    /// Local prediction.
    pub(crate) y: f64,
    pub(crate) model: &'a LocalModel,
    pub(crate) affine: &'a Affine,
}

impl<'a> Contribution<'a> {
    /// What `model` says at the normalised input `x`, if it is trustworthy and activated above `cutoff`.
    pub(crate) fn new(model: &'a LocalModel, kernel: Kernel, cutoff: f64, x: &DVector<f64>) -> Option<Self> {
        let affine = model.affine.as_ref()?;
        let (dx, v) = model.difference(x);
        let activation = kernel.at(dx.dot(&v));
        let y = affine.offset + dx.iter().zip(&affine.slope).map(|(dx, slope)| dx * slope).sum::<f64>();
        (activation.w > cutoff).then_some(Contribution { activation, v, y, model, affine })
    }

    /// Variance of the local prediction, Γ(1 + w Σ s²/Σ w s²); `None` before errors were collected.
    pub(crate) fn variance(&self, x: &DVector<f64>) -> Option<f64> {
        let loadings = self.affine.loadings.chunks_exact(x.len());
        let squares = loadings.map(|a| {
            let s: f64 = a.iter().zip(x).zip(&self.affine.mean).map(|((a, x), mean)| a * (x - mean)).sum();
            s * s
        });
        Some(self.affine.noise? * (1.0 + self.activation.w * squares.sum::<f64>()))
    }

    /// Second derivative of w by x: 4 w″ vvᵀ + 2 w′ D.
    pub(crate) fn activation_hessian(&self) -> DMatrix<f64> {
        let Activation { slope, curvature, .. } = self.activation;
        4.0 * curvature * &self.v * self.v.transpose() + 2.0 * slope * self.model.metric_matrix()
    }

    pub(crate) fn slope(&self) -> DVector<f64> {
        DVector::from_column_slice(&self.affine.slope)
    }
}

impl LocalModel {
    /// x − c and D(x − c).
    fn difference(&self, x: &DVector<f64>) -> (DVector<f64>, DVector<f64>) {
        let n = x.len();
        let dx = DVector::from_fn(n, |i, _| x[i] - self.centre[i]);
        let v = if self.metric.len() == n {
            DVector::from_fn(n, |i, _| self.metric[i] * dx[i])
        } else {
            DMatrixView::from_slice(&self.metric, n, n) * &dx
        };
        (dx, v)
    }

    /// Activation by the normalised input `x`.
    pub(crate) fn activation(&self, kernel: Kernel, x: &DVector<f64>) -> f64 {
        let (dx, v) = self.difference(x);
        kernel.at(dx.dot(&v)).w
    }

    fn metric_matrix(&self) -> DMatrix<f64> {
        let n = self.centre.len();
        if self.metric.len() == n {
            DMatrix::from_diagonal(&DVector::from_column_slice(&self.metric))
        } else {
            DMatrix::from_column_slice(n, n, &self.metric)
        }
    }
}
