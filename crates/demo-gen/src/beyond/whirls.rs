use motion::Policy;
use nalgebra::{DMatrix, DVectorView, DVectorViewMut};
use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

/// π(x) = −a x + b e^(−‖x‖²/2n) S x with S skew: moves to the origin while turning. It has no potential.
#[derive(Debug, Clone, PartialEq)]
pub struct Swirl {
    /// a, in 1/s.
    pub pull: f64,
    /// b, in 1/s.
    pub turn: f64,
    /// S, (n, n), skew, of spectral norm 1.
    pub skew: DMatrix<f64>,
}

impl Swirl {
    /// Draws a swirl that turns in random planes of `dim` ≥ 2 dimensions.
    pub fn draw<R: Rng + ?Sized>(dim: usize, rng: &mut R) -> Self {
        let entries = DMatrix::from_fn(dim, dim, |_, _| rng.sample::<f64, _>(StandardNormal));
        let skew = &entries - entries.transpose();
        let norm = skew.singular_values().max();
        Swirl { pull: 0.06, turn: 0.08, skew: skew / norm }
    }
}

impl Policy for Swirl {
    fn dim(&self) -> usize {
        self.skew.nrows()
    }

    fn action_into(&self, state: DVectorView<'_, f64>, mut action: DVectorViewMut<'_, f64>) {
        let fading = (-state.norm_squared() / (2.0 * self.dim() as f64)).exp();
        action.gemv(self.turn * fading, &self.skew, &state, 0.0);
        action.axpy(-self.pull, &state, 1.0);
    }
}

/// π(x) = v[(1 − ‖x‖²)x + (−x₂, x₁)] on the plane: moves onto the unit circle, and round it for ever.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LimitCycle {
    /// v, in 1/s.
    pub speed: f64,
}

impl Policy for LimitCycle {
    fn dim(&self) -> usize {
        2
    }

    fn action_into(&self, state: DVectorView<'_, f64>, mut action: DVectorViewMut<'_, f64>) {
        assert_eq!(state.len(), 2, "the limit cycle lies on the plane");
        let outward = 1.0 - state.norm_squared();
        action[0] = self.speed * (outward * state[0] - state[1]);
        action[1] = self.speed * (outward * state[1] + state[0]);
    }
}
