use motion::Potential;
use nalgebra::{DVector, DVectorView, DVectorViewMut};
use serde::Serialize;

/// `φ(x) = w‖x − x_c‖²` (24): a bowl, whose policy `−2w(x − x_c)` leads straight to its centre.
///
/// The paper uses w = 0.05 throughout.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Parabola {
    /// w, in 1/s.
    pub weight: f64,
    /// `x_c`, (n).
    pub centre: DVector<f64>,
}

impl Potential for Parabola {
    fn dim(&self) -> usize {
        self.centre.len()
    }

    fn value(&self, state: DVectorView<'_, f64>) -> f64 {
        assert_eq!(state.len(), self.dim(), "a state has the dimension of the potential");
        let distances = state.iter().zip(&self.centre).map(|(x, centre)| x - centre);
        self.weight * distances.map(|distance| distance * distance).sum::<f64>()
    }

    fn gradient_into(&self, state: DVectorView<'_, f64>, mut gradient: DVectorViewMut<'_, f64>) {
        state.sub_to(&self.centre, &mut gradient);
        gradient *= 2.0 * self.weight;
    }
}

/// φ(x) = a sin(x₁) cos(x₂) (26) on the plane: infinitely many maxima, minima and saddles.
///
/// The paper uses a = 0.1.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Sinusoidal {
    /// a, in units of the state squared per second.
    pub amplitude: f64,
}

impl Potential for Sinusoidal {
    fn dim(&self) -> usize {
        2
    }

    fn value(&self, state: DVectorView<'_, f64>) -> f64 {
        assert_eq!(state.len(), 2, "the sinusoidal potential lives on the plane");
        self.amplitude * state[0].sin() * state[1].cos()
    }

    fn gradient_into(&self, state: DVectorView<'_, f64>, mut gradient: DVectorViewMut<'_, f64>) {
        assert_eq!((state.len(), gradient.len()), (2, 2), "the sinusoidal potential lives on the plane");
        gradient[0] = self.amplitude * state[0].cos() * state[1].cos();
        gradient[1] = -self.amplitude * state[0].sin() * state[1].sin();
    }
}
