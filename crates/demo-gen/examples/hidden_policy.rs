//! Simulates constrained movements and prints the share of the policy that their constraints hide.

#![allow(clippy::print_stdout, reason = "a program")]

use demo_gen::{DemoGenError, Redraw, ToyPotential, ToySystem, demonstrations, with_position_noise};
use rand::SeedableRng as _;
use rand::rngs::StdRng;

fn main() -> Result<(), DemoGenError> {
    let mut rng = StdRng::seed_from_u64(1);
    let potential = ToyPotential::sinusoidal();
    let system = ToySystem { potential, n_trajectories: 20, redraw: Redraw::Segments(2), ..ToySystem::default() };
    let recordings = system.record(&mut rng)?;
    let demonstrations = demonstrations(&recordings)?;
    println!("{} movements, {} samples", demonstrations.n_trajectories(), demonstrations.n_samples());

    // An observer records N(x, t) π(x); π itself is part of the truth.
    let first = &recordings[0];
    for sample in [0, 19, 20, 39] {
        let wanted = first.truth.actions.column(sample);
        let moved = first.truth.projectors[sample].project(wanted);
        println!("sample {sample:>2}: wanted {:+.3?}, moved {:+.3?}", wanted.as_slice(), moved.as_slice());
    }
    let squares = |sums: (f64, f64), recording: &demo_gen::Recording| {
        let truth = &recording.truth;
        let moved = truth.projectors.iter().zip(truth.actions.column_iter()).map(|(n, u)| n.project(u).norm_squared());
        (sums.0 + moved.sum::<f64>(), sums.1 + truth.actions.norm_squared())
    };
    let (moved, wanted) = recordings.iter().fold((0.0, 0.0), squares);
    println!("constraints hide {:.0} % of the squared policy", 100.0 * (1.0 - moved / wanted));

    let noisy = with_position_noise(&recordings, 0.02, &mut rng)?;
    let error = noisy[0].observed.states() - &noisy[0].truth.states;
    println!("with noise of 2 % the first movement's positions are off by {:.3} at most", error.amax());
    Ok(())
}
