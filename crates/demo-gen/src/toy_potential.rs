use motion::Potential;
use nalgebra::{DVector, DVectorView, DVectorViewMut};
use serde::Serialize;

use crate::{Parabola, Sinusoidal};

/// The potentials of the toy system.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub enum ToyPotential {
    /// (24)
    Parabola(Parabola),
    /// (26)
    Sinusoidal(Sinusoidal),
}

impl ToyPotential {
    /// The paper's parabola on the plane: w = 0.05, centre 0.
    pub fn parabola() -> Self {
        ToyPotential::Parabola(Parabola { weight: 0.05, centre: DVector::zeros(2) })
    }

    /// The paper's sinusoidal potential: a = 0.1.
    pub fn sinusoidal() -> Self {
        ToyPotential::Sinusoidal(Sinusoidal { amplitude: 0.1 })
    }

    fn as_potential(&self) -> &dyn Potential {
        match self {
            ToyPotential::Parabola(potential) => potential,
            ToyPotential::Sinusoidal(potential) => potential,
        }
    }
}

impl Potential for ToyPotential {
    fn dim(&self) -> usize {
        self.as_potential().dim()
    }

    fn value(&self, state: DVectorView<'_, f64>) -> f64 {
        self.as_potential().value(state)
    }

    fn gradient_into(&self, state: DVectorView<'_, f64>, gradient: DVectorViewMut<'_, f64>) {
        self.as_potential().gradient_into(state, gradient);
    }
}
