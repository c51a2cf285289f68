use motion::Potential;
use nalgebra::{DMatrix, DVectorView, DVectorViewMut};
use rand::Rng;

use super::direction::direction;

/// φ(x) = −Σ_k a_k exp(−‖x − c_k‖²/2s²) + b‖x‖²: wells in a wide bowl. Smooth, but not a polynomial.
#[derive(Debug, Clone, PartialEq)]
pub struct Wells {
    /// a_k, in units of the state squared per second.
    pub depths: Vec<f64>,
    /// c_k, (n, K).
    pub centres: DMatrix<f64>,
    /// s, in units of the state.
    pub width: f64,
    /// b, in 1/s.
    pub bowl: f64,
}

impl Wells {
    /// Draws three wells in random directions from the origin. Their distances and steepness are similar in any
    /// dimension `dim`.
    pub fn draw<R: Rng + ?Sized>(dim: usize, rng: &mut R) -> Self {
        let root = (dim as f64).sqrt();
        let width = 0.75 * root;
        let mut centres = DMatrix::zeros(dim, 3);
        for (mut centre, distance) in centres.column_iter_mut().zip([1.0, 1.1, 0.9]) {
            centre.copy_from(&(distance * 1.2 * (dim as f64 / 2.0).sqrt() * direction(dim, rng)));
        }
        let depths = [1.0, 0.8, 0.9].map(|depth| depth * 0.12 * width * root / 1.4).to_vec();
        Wells { depths, centres, width, bowl: 0.005 }
    }

    /// a_k exp(−‖x − c_k‖²/2s²).
    fn fill(&self, well: usize, state: DVectorView<'_, f64>) -> f64 {
        let centre = self.centres.column(well);
        let distances = state.iter().zip(&centre).map(|(x, centre)| x - centre);
        let squared: f64 = distances.map(|distance| distance * distance).sum();
        self.depths[well] * (-squared / (2.0 * self.width * self.width)).exp()
    }
}

impl Potential for Wells {
    fn dim(&self) -> usize {
        self.centres.nrows()
    }

    fn value(&self, state: DVectorView<'_, f64>) -> f64 {
        assert_eq!(state.len(), self.dim(), "a state has the dimension of the potential");
        self.bowl * state.norm_squared() - (0..self.depths.len()).map(|well| self.fill(well, state)).sum::<f64>()
    }

    fn gradient_into(&self, state: DVectorView<'_, f64>, mut gradient: DVectorViewMut<'_, f64>) {
        gradient.copy_from(&state);
        gradient *= 2.0 * self.bowl;
        for well in 0..self.depths.len() {
            let pull = self.fill(well, state) / (self.width * self.width);
            gradient.axpy(pull, &state, 1.0);
            gradient.axpy(-pull, &self.centres.column(well), 1.0);
        }
    }
}
