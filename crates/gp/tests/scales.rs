//! The unit of each axis is learnt from constraints, which are orthogonal projections only in the right units.

use crate::systems::{ANGLES, HIMMELBLAU, System, WELLS};
use gp::{Family, FrontEnd, LearntScales, PushTest, Rows, SlopeGp};
use motion::scaled;
use nalgebra::DVector;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// The scales learnt if axis 1 was recorded in a unit too small by `factor`.
fn learnt(system: &System, factor: f64, noise: f64) -> Option<LearntScales> {
    pushed(system, factor, (0.0, noise), PushTest::AssumeNone)
}

fn pushed(system: &System, factor: f64, (push, noise): (f64, f64), push_test: PushTest) -> Option<LearntScales> {
    let right = FrontEnd::Velocities.rows(&system.movements(push, noise, 1)).unwrap();
    let factors = DVector::from_fn(system.dim, |axis, _| if axis == 1 { factor } else { 1.0 });
    let [states, velocities] = [right.states(), right.velocities()].map(|of| scaled(of, &factors));
    let rows = Rows::new(states, velocities, right.indices().to_vec()).unwrap();
    let gp = SlopeGp { families: vec![Family::Smooth], push_test, ..SlopeGp::default() };
    gp.learn_scales(&rows, &mut ChaCha8Rng::seed_from_u64(1)).unwrap()
}

fn worst_error(learnt: &LearntScales, factor: f64) -> f64 {
    let right = |axis| if axis == 1 { factor } else { 1.0 };
    let errors = learnt.factors.iter().enumerate().map(|(axis, scale)| (scale * right(axis) - 1.0).abs());
    errors.fold(0.0, f64::max)
}

#[test]
fn units_are_found() {
    for system in [HIMMELBLAU, ANGLES, WELLS] {
        for factor in [2.0, 5.0, 1000.0] {
            let learnt = learnt(&system, factor, 0.0).unwrap();
            let error = worst_error(&learnt, factor);
            assert!(error < 0.02, "{} dimensions, {factor}: {error:.1e}", system.dim);
            assert!(learnt.left_out.1 < 0.1 * learnt.left_out.0 && learnt.t > 2.5, "{learnt:?}");
        }
    }
}

#[test]
fn units_are_found_in_noise() {
    for system in [ANGLES, WELLS] {
        let error = worst_error(&learnt(&system, 5.0, 0.05).unwrap(), 5.0);
        assert!(error < 0.1, "{} dimensions: {error:.1e}", system.dim);
    }
}

/// A factor close to a plain one is replaced by it.
#[test]
fn millimetres_are_exact() {
    let learnt = learnt(&ANGLES, 1000.0, 0.0).unwrap();
    assert!((learnt.factors[1] * 1000.0 - 1.0).abs() < 1e-12, "{learnt:?}");
}

#[test]
fn right_units_stay() {
    for system in [HIMMELBLAU, ANGLES, WELLS] {
        for noise in [0.0, 0.05] {
            assert_eq!(learnt(&system, 1.0, noise), None, "{} dimensions, noise {noise}", system.dim);
        }
    }
}

/// Constraints that push, recorded in mixed units: from samples alone the scales are wrong or none.
#[test]
fn units_are_found_where_constraints_push() {
    for (system, noise, most) in [(ANGLES, 0.0, 0.02), (WELLS, 0.0, 0.02), (ANGLES, 0.02, 0.15)] {
        for factor in [5.0, 1000.0] {
            let learnt = pushed(&system, factor, (0.3, noise), PushTest::Fit).unwrap();
            let error = worst_error(&learnt, factor);
            assert!(error < most, "{} dimensions, noise {noise}, {factor}: {error:.1e} {learnt:?}", system.dim);
        }
        let right = pushed(&system, 1.0, (0.3, noise), PushTest::Fit);
        assert_eq!(right, None, "{} dimensions, noise {noise}", system.dim);
    }
}
