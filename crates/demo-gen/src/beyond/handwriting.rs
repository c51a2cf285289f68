use std::f64::consts::TAU;

use motion::Policy;
use nalgebra::{DVectorView, DVectorViewMut, Vector2};
use rand::{Rng, RngExt};

/// Number of steps along the line.
const POINTS: usize = 120;

/// Standard deviation of the weights about the nearest point of the line, in units of the state.
const WIDTH: f64 = 0.2;

/// A policy that writes a wavy line from left to right on the plane and comes to rest at its end. Near the line it
/// follows it; elsewhere it returns to it. Such free movement is no gradient flow, and stays in a corridor around the
/// line.
#[derive(Debug, Clone, PartialEq)]
pub struct Handwriting {
    /// Points of the line, and the desired velocities there.
    line: Vec<(Vector2<f64>, Vector2<f64>)>,
    /// Rate of the return to the line, in 1/s.
    back: f64,
}

impl Handwriting {
    /// Draws a random line of three waves from x₁ = −2 to 2, written in about 30 s.
    pub fn draw<R: Rng + ?Sized>(rng: &mut R) -> Self {
        let waves: Vec<(f64, f64, f64)> = [1.0, 2.0, 3.0]
            .map(|count| (TAU * count, rng.random_range(0.4..1.2) / count, rng.random_range(0.0..TAU)))
            .to_vec();
        let height = |s: f64| waves.iter().map(|(rate, height, phase)| height * (rate * s + phase).sin()).sum();
        let rise = |s: f64| -> f64 { waves.iter().map(|(rate, h, phase)| rate * h * (rate * s + phase).cos()).sum() };
        let line = (0..=POINTS).map(|point| {
            let s = point as f64 / POINTS as f64;
            let along = Vector2::new(4.0, rise(s)).normalize();
            let speed = 0.25 * ((1.0 - s) / 0.15).min(1.0);
            (Vector2::new(4.0 * s - 2.0, height(s)), speed * along)
        });
        Handwriting { line: line.collect(), back: 0.3 }
    }

    /// The beginning of the line.
    pub fn start(&self) -> Vector2<f64> {
        self.line[0].0
    }
}

impl Policy for Handwriting {
    fn dim(&self) -> usize {
        2
    }

    fn action_into(&self, state: DVectorView<'_, f64>, mut action: DVectorViewMut<'_, f64>) {
        assert_eq!(state.len(), 2, "the line lies on the plane");
        let state = Vector2::new(state[0], state[1]);
        let squared = |point: &Vector2<f64>| (point - state).norm_squared();
        let nearest = self.line.iter().map(|(point, _)| squared(point)).fold(f64::INFINITY, f64::min);
        let (mut wanted, mut total) = (Vector2::zeros(), 0.0);
        for (point, velocity) in &self.line {
            let weight = ((nearest - squared(point)) / (2.0 * WIDTH * WIDTH)).exp();
            wanted += weight * (velocity + self.back * (point - state));
            total += weight;
        }
        action.copy_from(&(wanted / total));
    }
}
