//! Learns one policy from constrained and from free movements, and prints which Gaussian process the data support.

#![allow(clippy::print_stdout, reason = "a program")]

use std::error::Error;

use gp::{AutoGp, FrontEnd};
use motion::{Demonstrations, LearntPolicy as _, MotionError, Policy as _, Trajectory};
use nalgebra::{DMatrix, dvector};
use rand::SeedableRng as _;
use rand::rngs::StdRng;

/// Twelve movements of the policy π(x) = −x: along rails, or free.
fn recorded(on_rails: bool) -> Result<Demonstrations, MotionError> {
    let movements = (0..12).map(|k| {
        let (angle, along) = (0.55 * f64::from(k), 0.9 * f64::from(k));
        let (start, rail) = (dvector![angle.cos(), angle.sin()] * 1.5, dvector![along.cos(), along.sin()]);
        let sliding = if on_rails { &rail * rail.dot(&start) } else { start.clone() };
        let left = |sample: usize| (-0.1 * sample as f64).exp();
        let states = DMatrix::from_fn(2, 20, |axis, i| start[axis] + (left(i) - 1.0) * sliding[axis]);
        let velocities = DMatrix::from_fn(2, 20, |axis, i| -left(i) * sliding[axis]);
        Trajectory::new(states, 0.1)?.with_velocities(velocities)
    });
    Demonstrations::new(movements.collect::<Result<_, _>>()?)
}

fn main() -> Result<(), Box<dyn Error>> {
    for on_rails in [true, false] {
        let rows = FrontEnd::Velocities.rows(&recorded(on_rails)?)?;
        let learnt = AutoGp::default().fit(&rows, &mut StdRng::seed_from_u64(1))?;
        println!("movements on rails: {on_rails}; the data say {:?}", learnt.reading());
        println!("  expected error {:.0e}; the slope GP's policy: {}", learnt.expected_nupe(), learnt.takes_slope());
        let x = dvector![0.3, -0.4];
        let (action, mut deviation) = (learnt.action(x.as_view()), dvector![0.0, 0.0]);
        learnt.action_sd_into(x.as_view(), deviation.as_view_mut());
        println!("  at {:?}: action {:+.3?} ± {:.0e}", x.as_slice(), action.as_slice(), deviation.amax());
        for warning in learnt.warnings() {
            println!("  warning: {warning}");
        }
    }
    Ok(())
}
