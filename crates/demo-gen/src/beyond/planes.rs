use motion::Potential;
use nalgebra::{DMatrix, DVector, DVectorView, DVectorViewMut};
use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

use super::direction::direction;

/// φ(x) = m Σ_k σ(w_kᵀx − b_k) + b‖x‖², where the slope of σ rises from 0 to 1: planes that meet at edges, which are
/// sharp for an edge of width 0 (σ(y) = max(y, 0)), else rounded (σ(y) = h log(1 + e^(y/h))).
#[derive(Debug, Clone, PartialEq)]
pub struct Planes {
    /// w_k, of length 1, (n, K).
    pub normals: DMatrix<f64>,
    /// b_k, in units of the state.
    pub offsets: DVector<f64>,
    /// m, in units of the state per second.
    pub slope: f64,
    /// h, in units of the state; 0 for kinks.
    pub edge: f64,
    /// b, in 1/s.
    pub bowl: f64,
}

impl Planes {
    /// Draws three planes in random directions, with edges of width `edge`.
    pub fn draw<R: Rng + ?Sized>(dim: usize, edge: f64, rng: &mut R) -> Self {
        let normals: Vec<_> = (0..3).map(|_| direction(dim, rng)).collect();
        let offsets = DVector::from_fn(3, |_, _| 0.2 + 0.3 * rng.sample::<f64, _>(StandardNormal).abs());
        Planes { normals: DMatrix::from_columns(&normals), offsets, slope: 0.15, edge, bowl: 0.02 }
    }

    /// σ(y).
    fn rise(&self, height: f64) -> f64 {
        if self.edge == 0.0 {
            return height.max(0.0);
        }
        height.max(0.0) + self.edge * (-height.abs() / self.edge).exp().ln_1p()
    }

    /// σ'(y); 0 on a kink.
    fn steepness(&self, height: f64) -> f64 {
        if self.edge == 0.0 {
            return if height > 0.0 { 1.0 } else { 0.0 };
        }
        1.0 / (1.0 + (-height / self.edge).exp())
    }
}

impl Potential for Planes {
    fn dim(&self) -> usize {
        self.normals.nrows()
    }

    fn value(&self, state: DVectorView<'_, f64>) -> f64 {
        let planes = self.normals.column_iter().zip(&self.offsets);
        let ramps: f64 = planes.map(|(normal, offset)| self.rise(normal.dot(&state) - offset)).sum();
        self.slope * ramps + self.bowl * state.norm_squared()
    }

    fn gradient_into(&self, state: DVectorView<'_, f64>, mut gradient: DVectorViewMut<'_, f64>) {
        gradient.copy_from(&state);
        gradient *= 2.0 * self.bowl;
        for (normal, offset) in self.normals.column_iter().zip(&self.offsets) {
            let steepness = self.steepness(normal.dot(&state) - offset);
            gradient.axpy(self.slope * steepness, &normal, 1.0);
        }
    }
}
