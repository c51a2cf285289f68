//! All joints follow a movement of the palms: what is reported is true, and how good it is.

mod robots;

use constraints::Unconstrained;
use demo_gen::{DemoGenError, Grasp, GraspStart, JointPath, PalmTracking, UpperBody};
use kinematics::{KinematicsError, Workspace};
use motion::Trajectory;
use nalgebra::{DMatrix, DVector, DVectorView, Vector3};
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use robots::upper_body;

/// The distance of each palm from where it should be, from forward kinematics anew.
fn literal_errors(body: &UpperBody, path: &JointPath, palms: &Trajectory) -> DMatrix<f64> {
    DMatrix::from_fn(2, palms.n_samples(), |hand, sample| {
        let reached = body.palms(path.configurations.column(sample)).expect("a path of this body")[hand];
        (reached.coords - palms.state(sample).fixed_rows::<3>(3 * hand)).norm()
    })
}

/// The clearance of each configuration anew; it is 0 exactly where links collide.
fn literal_clearances(body: &UpperBody, path: &JointPath) -> DVector<f64> {
    let mut workspace = Workspace::new();
    let clearance = |q: DVectorView<'_, f64>| {
        let poses = body.robot().forward_kinematics(q, &mut workspace).expect("a path of this body");
        let distance = body.collision().clearance(&poses).expect("links that must not touch").distance;
        assert_eq!(distance == 0.0, body.collision().collides(&poses));
        distance
    };
    DVector::from_iterator(path.clearances.len(), path.configurations.column_iter().map(clearance))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn the_path_keeps_the_limits_and_tells_its_errors(
        seed in any::<u64>(), damping in 0.001..0.2f64, pull in 0.0..0.5f64, clearance in 0.0..0.03f64,
        corrections in 1..8usize,
    ) {
        let grasp = Grasp::new(upper_body());
        let start = grasp.start(&mut ChaCha8Rng::seed_from_u64(seed)).unwrap();
        let recording = grasp.movement(&start).unwrap();
        let tracking = PalmTracking { damping, pull, clearance, corrections };
        let path = tracking.follow(&grasp.body, &recording.observed, start.posture.as_view()).unwrap();
        prop_assert_eq!(path.configurations.column(0), start.posture.column(0));
        for q in path.configurations.column_iter() {
            prop_assert_eq!(grasp.body.robot().n_beyond_limits(q).unwrap(), 0);
        }
        prop_assert!((literal_errors(&grasp.body, &path, &recording.observed) - &path.errors).amax() < 1e-14);
        prop_assert!(path.errors.column(0).amax() < 1e-14);
        prop_assert_eq!(literal_clearances(&grasp.body, &path), path.clearances);
    }
}

/// The palms' way to the ball with nothing between, and bows to the side of up to 6 cm, which end elsewhere.
fn bowed(grasp: &Grasp, start: &GraspStart, rng: &mut ChaCha8Rng) -> Trajectory {
    let free = Unconstrained { n_states: 6 };
    let straight = grasp.roll_out.record(&grasp.scene.potential(), &free, start.palms.as_view());
    let straight = straight.expect("nothing is in the way").observed;
    let mut draw = || rng.random_range(-1.0..1.0f64);
    let bows = DMatrix::from_fn(6, 3, |_, _| draw());
    let bowed = DMatrix::from_fn(6, straight.n_samples(), |row, sample| {
        let part = 1.0 - 0.95f64.powf(sample as f64);
        let bow = |waves: f64| (part * waves * std::f64::consts::PI).sin();
        // The ends differ in y and z: the ball is at the edge of reach.
        let end = if row % 3 == 0 { 0.0 } else { part * bows[(row, 2)] };
        straight.state(sample)[row] + 0.06 * (bows[(row, 0)] * bow(1.0) + 0.5 * bows[(row, 1)] * bow(2.0) + end)
    });
    Trajectory::new(bowed, 0.5).expect("two samples or more")
}

/// Whether the joints can keep all links apart: hands are 3.5 cm thick, and palms may be asked nearer to a leg or to each
/// other than that.
fn is_possible(palms: &Trajectory) -> bool {
    palms.positions().column_iter().all(|palms| {
        let [left, right] = [0, 3].map(|at| Vector3::from(palms.fixed_rows::<3>(at)));
        let from_legs = [0.075, -0.075].into_iter().flat_map(|y| {
            [left, right].map(|palm| (palm - Vector3::new(0.05, y, palm.z.clamp(0.08, 0.56))).norm() - 0.055)
        });
        from_legs.fold(f64::INFINITY, f64::min) > 0.0175 && (left - right).norm() > 0.12
    })
}

/// With the defaults the robot carries out what the palms do to within a third of a millimetre, without jerks, and
/// nothing of it touches anything else of it: demonstrations, and what policies do under other constraints.
#[test]
fn movements_are_followed_closely_and_links_keep_apart() {
    let grasp = Grasp::new(upper_body());
    let obstacle = grasp.scene.central_obstacle().unwrap();
    let potential = grasp.scene.potential();
    let (mut n_possible, mut n_paths) = (0, 0);
    for seed in [1, 2] {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        for _ in 0..20 {
            let start = grasp.start(&mut rng).unwrap();
            let demonstrated = grasp.movement(&start).unwrap().observed;
            let around = grasp.roll_out.record(&potential, &obstacle, start.palms.as_view()).unwrap().observed;
            for palms in [demonstrated, around, bowed(&grasp, &start, &mut rng)] {
                n_paths += 1;
                if !is_possible(&palms) {
                    continue;
                }
                n_possible += 1;
                let path = PalmTracking::default().follow(&grasp.body, &palms, start.posture.as_view()).unwrap();
                assert!(path.clearances.min() > 0.0, "{start:?}");
                assert!(path.errors.max() < 3.5e-4, "{}", path.errors.max());
                let (before, after) = (path.configurations.columns(0, 99), path.configurations.columns(1, 99));
                assert!((after - before).amax() < 0.3, "{}", (after - before).amax());
            }
        }
    }
    assert!(n_possible > n_paths * 8 / 10, "{n_possible} of {n_paths}");
}

#[test]
fn what_is_out_of_reach_is_missed_by_what_is_told() {
    let body = upper_body();
    let far = DMatrix::from_fn(6, 3, |row, _| if row % 3 == 0 { 3.0 } else { 0.0 });
    let palms = Trajectory::new(far, 1.0).unwrap();
    let path = PalmTracking::default().follow(&body, &palms, body.ready().as_view()).unwrap();
    assert!(path.errors.min() > 1.5);
    assert!((literal_errors(&body, &path, &palms) - &path.errors).amax() < 1e-14);
}

/// A palm goes where it should, and be it into a leg; the clearances tell.
#[test]
fn where_the_body_is_in_the_way_the_palm_goes_first() {
    let body = upper_body();
    let [left, right] = body.palms(body.ready().as_view()).unwrap();
    let (from, right) = (left.coords, right.coords);
    let palms = DMatrix::from_fn(6, 40, |row, sample| match row {
        0..3 => from[row] + (Vector3::new(0.05, 0.075, 0.54)[row] - from[row]) * (sample as f64 / 39.0),
        _ => right[row - 3],
    });
    let palms = Trajectory::new(palms, 0.5).unwrap();
    let path = PalmTracking::default().follow(&body, &palms, body.ready().as_view()).unwrap();
    assert!(path.clearances[0] > 0.005 && path.clearances[39] == 0.0, "{}", path.clearances);
    assert!(path.errors.max() < 3e-3, "{}", path.errors.max());
    assert_eq!(literal_clearances(&body, &path), path.clearances);
}

#[test]
fn bad_input_is_refused() {
    let body = upper_body();
    let palms = |n_states| Trajectory::new(DMatrix::zeros(n_states, 2), 1.0).unwrap();
    let follow = |tracking: PalmTracking, n_states, n_joints| {
        tracking.follow(&body, &palms(n_states), DVector::zeros(n_joints).as_view()).unwrap_err()
    };
    let good = PalmTracking::default();
    assert_eq!(follow(good, 3, 22), DemoGenError::Palms { found: 3 });
    for (pull, corrections) in [(-0.1, 1), (1.1, 1), (0.1, 0)] {
        let expected = DemoGenError::Tracking { pull, corrections };
        assert_eq!(follow(PalmTracking { pull, corrections, ..good }, 6, 22), expected);
    }
    for clearance in [-0.001, f64::INFINITY] {
        assert_eq!(follow(PalmTracking { clearance, ..good }, 6, 22), DemoGenError::Clearance { clearance });
    }
    let damping = DemoGenError::Robot(KinematicsError::Damping { damping: -1.0 });
    assert_eq!(follow(PalmTracking { damping: -1.0, ..good }, 6, 22), damping);
    let length = DemoGenError::Robot(KinematicsError::ConfigurationLength { found: 21, expected: 22 });
    assert_eq!(follow(good, 6, 21), length);

    let no_yaw = UpperBody::new(&robots::UPPER_BODY.replace("l_shoulder_yaw\"", "l_twist\""), robots::UPPER_BODY_SRDF);
    let refused = good.follow(&no_yaw.unwrap(), &palms(6), DVector::zeros(22).as_view()).unwrap_err();
    assert!(
        matches!(refused, DemoGenError::Robot(KinematicsError::UnknownJoint { name, .. }) if name == "l_shoulder_yaw")
    );
}
