//! Movements towards a new goal each, past a fixed obstacle, under constraints that differ between movements and switch once within each.

use motion::{Demonstrations, Trajectory};
use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

const SAMPLES: usize = 40;
const SPAN: f64 = 1.5;

/// The attraction of a goal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Attraction {
    /// ½ |x − c|².
    Quadratic,
    /// −e^{−|x − c|²/2w²} w², a well of width w.
    Well,
}

pub(crate) struct Goals {
    pub(crate) dim: usize,
    pub(crate) attraction: Attraction,
}

const WELL: f64 = 1.5;
const OBSTACLE: f64 = 0.7;

impl Goals {
    /// π(x; c) = −∇φ.
    pub(crate) fn policy(&self, x: &DVector<f64>, goal: &DVector<f64>) -> DVector<f64> {
        let to_goal = goal - x;
        let attracted = match self.attraction {
            Attraction::Quadratic => to_goal,
            Attraction::Well => &to_goal * (-to_goal.norm_squared() / (2.0 * WELL * WELL)).exp() * 2.0,
        };
        let place = DVector::from_fn(self.dim, |axis, _| [0.2, -0.3, 0.4][axis]);
        let from = x - place;
        attracted + &from * (0.8 / OBSTACLE * (-from.norm_squared() / (2.0 * OBSTACLE * OBSTACLE)).exp())
    }

    /// `count` movements, with their goals as contexts.
    pub(crate) fn movements(&self, count: usize, seed: u64) -> Demonstrations {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let within = |rng: &mut ChaCha8Rng, span: f64| {
            DVector::from_fn(self.dim, |_, _| span * (2.0 * rng.random::<f64>() - 1.0))
        };
        let movements = (0..count).map(|_| {
            let (mut x, goal) = (within(&mut rng, SPAN), within(&mut rng, 0.7 * SPAN));
            let mut normal = within(&mut rng, 1.0).normalize();
            let (mut states, mut velocities) = (Vec::new(), Vec::new());
            for sample in 0..SAMPLES {
                if sample == SAMPLES / 2 {
                    normal = within(&mut rng, 1.0).normalize();
                }
                let policy = self.policy(&x, &goal);
                let u = &policy - &normal * normal.dot(&policy);
                states.extend_from_slice(x.as_slice());
                velocities.extend_from_slice(u.as_slice());
                x += 0.08 * u;
            }
            let matrix = |numbers| DMatrix::from_vec(self.dim, SAMPLES, numbers);
            let movement = Trajectory::new(matrix(states), 0.08).unwrap().with_velocities(matrix(velocities)).unwrap();
            movement.with_context(goal).unwrap()
        });
        Demonstrations::new(movements.collect()).unwrap()
    }
}
