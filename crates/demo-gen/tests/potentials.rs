//! The potentials (24) and (26): their values, and their gradients compared with differences.

use demo_gen::{Parabola, Sinusoidal, ToyPotential};
use motion::Potential;
use nalgebra::{DVector, DVectorView, dvector};
use proptest::collection::vec;
use proptest::prelude::*;

/// Central differences with a step whose error and rounding are both about 1e-10 of the potential.
fn gradient_by_differences(potential: &impl Potential, state: DVectorView<'_, f64>) -> DVector<f64> {
    let step = 1e-5;
    DVector::from_fn(state.len(), |dimension, _| {
        let at = |offset: f64| {
            let mut moved = state.into_owned();
            moved[dimension] += offset;
            potential.value(moved.as_view())
        };
        (at(step) - at(-step)) / (2.0 * step)
    })
}

fn close(found: &DVector<f64>, expected: &DVector<f64>, tolerance: f64) -> Result<(), TestCaseError> {
    prop_assert!((found - expected).amax() <= tolerance, "found {}, expected {}", found, expected);
    Ok(())
}

proptest! {
    #[test]
    fn a_parabola(weight in -2.0..2.0f64, pairs in vec((-5.0..5.0f64, -5.0..5.0f64), 1..6)) {
        let (state, centre): (Vec<f64>, Vec<f64>) = pairs.into_iter().unzip();
        let (state, centre) = (DVector::from_vec(state), DVector::from_vec(centre));
        let potential = Parabola { weight, centre: centre.clone() };
        prop_assert_eq!(potential.dim(), state.len());
        prop_assert!((potential.value(state.as_view()) - weight * (&state - &centre).norm_squared()).abs() < 1e-12);
        close(&potential.gradient(state.as_view()), &gradient_by_differences(&potential, state.as_view()), 1e-7)?;
        prop_assert_eq!(potential.gradient(centre.as_view()), DVector::zeros(centre.len()));
    }

    #[test]
    fn a_sinusoid(amplitude in -2.0..2.0f64, x in -9.0..9.0f64, y in -9.0..9.0f64) {
        let (potential, state) = (Sinusoidal { amplitude }, dvector![x, y]);
        prop_assert!((potential.value(state.as_view()) - amplitude * x.sin() * y.cos()).abs() < 1e-15);
        close(&potential.gradient(state.as_view()), &gradient_by_differences(&potential, state.as_view()), 1e-8)?;
    }

    #[test]
    fn the_toys_have_the_papers_constants(x in -2.0..2.0f64, y in -2.0..2.0f64) {
        let state = dvector![x, y];
        let values = [
            (ToyPotential::parabola(), 0.05 * (x * x + y * y)),
            (ToyPotential::sinusoidal(), 0.1 * x.sin() * y.cos()),
        ];
        for (potential, value) in values {
            prop_assert_eq!(potential.dim(), 2);
            prop_assert!((potential.value(state.as_view()) - value).abs() < 1e-15);
            close(&potential.gradient(state.as_view()), &gradient_by_differences(&potential, state.as_view()), 1e-9)?;
        }
    }
}
