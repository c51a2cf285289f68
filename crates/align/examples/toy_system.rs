//! Learns the paper's toy system from constrained movements: PolicyAlign and naive averaging, scored against the truth.

#![allow(clippy::print_stdout, reason = "a program")]

use std::error::Error;

use align::{Bandwidth, DirectPolicyLearning, LwprRegressor, PolicyAlign};
use demo_gen::{Recording, ToySystem, demonstrations};
use metrics::nupe;
use motion::Policy;
use nalgebra::DMatrix;
use rand::SeedableRng as _;
use rand::rngs::StdRng;

fn main() -> Result<(), Box<dyn Error>> {
    let mut rng = StdRng::seed_from_u64(1);
    // 40 movements down a bowl, each along rails that change midway.
    let recordings = ToySystem::default().record(&mut rng)?;
    let demonstrations = demonstrations(&recordings)?;
    println!("{} movements, {} samples", demonstrations.n_trajectories(), demonstrations.n_samples());

    let aligned = PolicyAlign { bandwidth: Bandwidth::Medium, ..PolicyAlign::default() }.align(&demonstrations)?;
    println!("{} movements in one group, bandwidth σ² = {:.3}", aligned.kept().len(), aligned.sigma_squared());
    for warning in aligned.warnings() {
        println!("warning: {warning}");
    }
    let learnt = aligned.learn(&LwprRegressor::default(), &mut rng)?;
    let naive = DirectPolicyLearning::default().learn_policy(&demonstrations, &[], &mut rng)?;
    println!("error of PolicyAlign      {:.4}", error(&learnt, &recordings)?);
    println!("error of naive averaging  {:.4}", error(&naive, &recordings)?);
    Ok(())
}

/// The unconstrained policy's error at all recorded states, as a share of its variance.
fn error(policy: &dyn Policy, recordings: &[Recording]) -> Result<f64, metrics::MetricsError> {
    let truths = || recordings.iter().map(|recording| &recording.truth);
    let wanted: Vec<_> = truths().flat_map(|truth| truth.actions.column_iter()).collect();
    let learnt: Vec<_> = truths().flat_map(|truth| truth.states.column_iter()).map(|x| policy.action(x)).collect();
    nupe(&DMatrix::from_columns(&wanted), &DMatrix::from_columns(&learnt))
}
