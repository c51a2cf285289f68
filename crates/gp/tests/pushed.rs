//! Constraints that push, A u = b with b ≠ 0: policies are found from the directions in which velocities differ.

#![allow(clippy::unwrap_used)] // A panic is how a test fails.

mod systems;

use gp::{AutoFit, AutoGp, DirectGp, FrontEnd, Hypothesis, PushTest, SlopeGp};
use motion::Policy;
use nalgebra::DVector;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use systems::{ANGLES, HIMMELBLAU, System, WELLS};

fn learnt(system: &System, push: f64, noise: f64, seed: u64) -> AutoFit {
    let rows = FrontEnd::Velocities.rows(&system.movements(push, noise, seed)).unwrap();
    let learner = AutoGp {
        slope: SlopeGp { max_rows: 400, hyper_rows: 200, push_test: PushTest::Fit, ..SlopeGp::default() },
        direct: DirectGp { max_rows: 400, hyper_rows: 200, ..DirectGp::default() },
        ..AutoGp::default()
    };
    learner.fit(&rows, &mut ChaCha8Rng::seed_from_u64(seed)).unwrap()
}

/// nUPE on states of new movements.
fn error(system: &System, fit: &dyn Policy, seed: u64) -> f64 {
    let fresh = system.movements(0.0, 0.0, 1000 + seed);
    let states = fresh.trajectories().iter().take(30).flat_map(|movement| movement.states().column_iter().step_by(2));
    let states: Vec<DVector<f64>> = states.map(|x| DVector::from_column_slice(x.as_slice())).collect();
    let truth: Vec<DVector<f64>> = states.iter().map(|x| system.policy(x)).collect();
    let mean = truth.iter().fold(DVector::zeros(system.dim), |sum, u| sum + u) / truth.len() as f64;
    let spread: f64 = truth.iter().map(|u| (u - &mean).norm_squared()).sum();
    let apart: f64 = states.iter().zip(&truth).map(|(x, u)| (fit.action(x.as_view()) - u).norm_squared()).sum();
    apart / spread
}

/// Even a push of three hundredths of the policy, or of a third, leaves nothing of the error.
#[test]
fn pushes_do_not_spoil_the_policy() {
    for (system, most) in [(HIMMELBLAU, 1e-6), (ANGLES, 1e-2), (WELLS, 1e-2)] {
        for push in [0.03, 0.3] {
            let fit = learnt(&system, push, 0.0, 1);
            let (reading, found, error) = (fit.reading(), fit.slope().report().push, error(&system, &fit, 1));
            assert_eq!(reading, Hypothesis::Constrained, "{} dimensions, push {push}", system.dim);
            assert!(error < most, "{} dimensions, push {push}: {error:.1e}", system.dim);
            assert!(found.is_some_and(|found| found > 0.5 * push && found < 3.0 * push), "{push}: {found:?}");
            assert!(fit.text().contains("The constraints also pushed"), "{}", fit.text());
        }
    }
}

/// Velocities with five per cent of noise, and a push of a third of the policy: without stretches .11 to .67 is left.
#[test]
fn pushes_are_found_in_noise() {
    let error = error(&ANGLES, &learnt(&ANGLES, 0.3, 0.05, 1), 1);
    assert!(error < 0.06, "{error:.1e}");
}

/// Where nothing pushes, rows stay those of samples.
#[test]
fn without_a_push_none_is_found() {
    for system in [HIMMELBLAU, ANGLES, WELLS] {
        assert_eq!(learnt(&system, 0.0, 0.0, 2).slope().report().push, None, "{} dimensions", system.dim);
    }
}
