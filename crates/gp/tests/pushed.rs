//! Constraints that push, A u = b with b ≠ 0: policies are found from the directions in which velocities differ.

#![allow(clippy::unwrap_used)] // A panic is how a test fails.

mod drawn;
mod systems;

use gp::{AutoFit, FrontEnd, Hypothesis};
use systems::{ANGLES, HIMMELBLAU, System, WELLS, error};

fn learnt(system: &System, push: f64, noise: f64, seed: u64) -> AutoFit {
    systems::learnt(&FrontEnd::Velocities.rows(&system.movements(push, noise, seed)).unwrap(), seed)
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
