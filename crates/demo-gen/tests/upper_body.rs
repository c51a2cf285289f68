//! Start states of the upper body: their location and spread, and refused input.

use crate::robots::{UPPER_BODY, UPPER_BODY_SRDF, upper_body};
use demo_gen::{DemoGenError, Side, UpperBody};
use kinematics::{KinematicsError, Workspace};
use nalgebra::DVector;
use proptest::prelude::*;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn starts_are_within_limits_and_free_of_collisions(variance in 0.0..2.0f64, seed in any::<u64>()) {
        let body = upper_body();
        let mut workspace = Workspace::new();
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut again = ChaCha8Rng::seed_from_u64(seed);
        for _ in 0..5 {
            let q = body.start(variance, &mut rng).unwrap();
            prop_assert_eq!(&q, &body.start(variance, &mut again).unwrap());
            prop_assert_eq!(body.robot().n_beyond_limits(q.as_view()).unwrap(), 0);
            let poses = body.robot().forward_kinematics(q.as_view(), &mut workspace).unwrap();
            prop_assert!(!body.collision().collides(&poses));
            let palms = body.palms(q.as_view()).unwrap();
            for (name, palm) in ["l_palm", "r_palm"].into_iter().zip(palms) {
                prop_assert!((poses.position(body.robot().link(name).unwrap()) - palm).norm() < 1e-14);
            }
        }
    }
}

/// Coordinates far from their limits have the requested mean and variance.
#[test]
fn starts_spread_around_the_posture_as_asked() {
    let body = upper_body();
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let variance = 0.01;
    let starts: Vec<DVector<f64>> = (0..4000).map(|_| body.start(variance, &mut rng).unwrap()).collect();
    for (joint, ready) in [("l_elbow", -1.6), ("r_shoulder_pitch", 0.3), ("neck_yaw", 0.0), ("l_wrist_yaw", 0.0)] {
        let at = body.robot().joint(joint).unwrap();
        assert_eq!(body.ready()[at], ready);
        let n = starts.len() as f64;
        let mean = starts.iter().map(|q| q[at]).sum::<f64>() / n;
        let spread = starts.iter().map(|q| (q[at] - ready).powi(2)).sum::<f64>() / n;
        // Five standard errors.
        assert!((mean - ready).abs() < 5.0 * (variance / n).sqrt(), "{joint}: mean {mean}");
        assert!((spread / variance - 1.0).abs() < 5.0 * (2.0 / n).sqrt(), "{joint}: variance {spread}");
    }
    assert_eq!(body.start(0.0, &mut rng).as_ref(), Ok(body.ready()));
}

#[test]
fn each_side_has_its_hand() {
    let body = upper_body();
    let mut workspace = Workspace::new();
    let palms = body.palms(body.ready().as_view()).unwrap();
    for (side, palm) in Side::BOTH.into_iter().zip(palms) {
        let pose = body.palm(side).pose(body.ready().as_view(), &mut workspace).unwrap();
        assert_eq!(pose.translation.vector, palm.coords);
        assert_eq!(side == Side::Left, palm.y > 0.0);
    }
}

#[test]
fn unsuitable_bodies_and_starts_are_refused() {
    let refused = |urdf: &str, srdf: &str| UpperBody::new(urdf, srdf).expect_err("this must be refused");
    let no_palm = UPPER_BODY.replace("r_palm\"", "r_hook\"");
    assert!(matches!(
        refused(&no_palm, UPPER_BODY_SRDF),
        DemoGenError::Robot(KinematicsError::UnknownLink { name, .. }) if name == "r_palm"
    ));
    let no_elbow = UPPER_BODY.replace("l_elbow\"", "l_hinge\"");
    assert!(matches!(
        refused(&no_elbow, UPPER_BODY_SRDF),
        DemoGenError::Robot(KinematicsError::UnknownJoint { name, .. }) if name == "l_elbow"
    ));
    assert!(matches!(refused("<robot", UPPER_BODY_SRDF), DemoGenError::Robot(KinematicsError::NotXml { .. })));

    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let body = upper_body();
    for variance in [-0.1, f64::INFINITY] {
        assert_eq!(body.start(variance, &mut rng).unwrap_err(), DemoGenError::StartVariance { variance });
    }
    // Without the SRDF the torso always penetrates the legs.
    let stuck = UpperBody::new(UPPER_BODY, "<robot/>").unwrap();
    assert_eq!(stuck.start(1e-4, &mut rng).unwrap_err(), DemoGenError::NoFreeStart { draws: 10_000 });
    assert!(matches!(body.palms(DVector::zeros(3).as_view()), Err(DemoGenError::Robot(_))));
}
