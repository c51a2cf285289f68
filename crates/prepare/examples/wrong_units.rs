//! Prepares recordings whose velocities have the wrong unit, and prints the decisions and findings.

#![allow(clippy::print_stdout, reason = "a program")]

use motion::{Channel, Episode, Recordings, Source, Times};
use nalgebra::DMatrix;
use prepare::{PrepareError, PrepareOptions, prepare};

/// A movement towards the origin at 20 Hz: positions in metres, velocities erroneously in millimetres per second.
fn movement(k: u8) -> Episode {
    let position = |axis: usize, i: usize| (f64::from(k) + axis as f64).cos() * (-0.025 * i as f64).exp();
    Episode {
        name: format!("take {k}"),
        source: Source::default(),
        times: Times::Even { step: 0.05, len: 40 },
        positions: DMatrix::from_fn(2, 40, position),
        velocities: Some(DMatrix::from_fn(2, 40, |axis, i| -500.0 * position(axis, i))),
        constraint: None,
        context: nalgebra::DVector::zeros(0),
    }
}

fn main() -> Result<(), PrepareError> {
    let state = ["x", "y"].map(|name| Channel { name: name.to_owned(), unit: Some("m".to_owned()) });
    let mut episodes: Vec<Episode> = (0..12).map(movement).collect();
    episodes.push(Episode { name: "copy".to_owned(), ..movement(3) });
    let recordings = Recordings { state: state.to_vec(), episodes, findings: vec![] };

    let prepared = prepare(&recordings, &PrepareOptions::default())?;
    println!("{} movements at {} s", prepared.demonstrations.n_trajectories(), prepared.time_step);
    for decision in &prepared.decisions {
        println!("decided  {} {}: {} (change it with {})", decision.what, decision.value, decision.why, decision.flag);
    }
    for finding in &prepared.findings {
        println!("{:?}  {}; next: {}", finding.verdict, finding.what, finding.next);
    }
    for left_out in &prepared.left_out {
        println!("left out  {}: {}", left_out.episode, left_out.why);
    }
    Ok(())
}
