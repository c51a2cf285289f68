//! Random movements: any number of trajectories, lengths, dimensions and time steps.

use align::{Bandwidth, Integration};
use motion::{Demonstrations, Trajectory};
use nalgebra::DMatrix;
use proptest::collection::vec;
use proptest::prelude::*;

fn matrix(dim: usize, n_samples: usize) -> impl Strategy<Value = DMatrix<f64>> {
    vec(-1.0..1.0, dim * n_samples).prop_map(move |values| DMatrix::from_vec(dim, n_samples, values))
}

fn trajectory(dim: usize) -> impl Strategy<Value = Trajectory> {
    (2usize..12, 0.01..3.0).prop_flat_map(move |(n_samples, time_step)| {
        (matrix(dim, n_samples), matrix(dim, n_samples)).prop_map(move |(positions, velocities)| {
            let trajectory = Trajectory::new(positions, time_step).expect("finite states");
            trajectory.with_velocities(velocities).expect("finite velocities")
        })
    })
}

/// At least `least` trajectories with velocities, in 1 to 7 dimensions: both more and fewer than the search unrolls.
pub(crate) fn demonstrations(least: usize) -> impl Strategy<Value = Demonstrations> {
    (1usize..8)
        .prop_flat_map(move |dim| vec(trajectory(dim), least..8))
        .prop_map(|trajectories| Demonstrations::new(trajectories).expect("one state space"))
}

pub(crate) fn integration() -> impl Strategy<Value = Integration> {
    prop_oneof![Just(Integration::Displacement), Just(Integration::Velocity), Just(Integration::Work)]
}

pub(crate) fn bandwidth() -> impl Strategy<Value = Bandwidth> {
    prop_oneof![
        Just(Bandwidth::Narrow),
        Just(Bandwidth::Medium),
        Just(Bandwidth::Wide),
        (0.001..1.0).prop_map(Bandwidth::Fixed),
    ]
}

/// The same movements with all positions mapped, velocities mapped by `velocity`, and time steps unchanged.
#[allow(dead_code)] // Not every test maps.
pub(crate) fn mapped(
    demonstrations: &Demonstrations,
    position: impl Fn(&DMatrix<f64>) -> DMatrix<f64>,
    velocity: impl Fn(&DMatrix<f64>) -> DMatrix<f64>,
) -> Demonstrations {
    let trajectories = demonstrations.trajectories().iter().map(|t| {
        let mapped = Trajectory::new(position(t.states()), t.time_step()).expect("finite states");
        mapped.with_velocities(velocity(t.velocities().expect("they are drawn"))).expect("finite velocities")
    });
    Demonstrations::new(trajectories.collect()).expect("one state space")
}
