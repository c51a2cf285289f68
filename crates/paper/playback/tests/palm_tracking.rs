//! All joints follow a movement of the palms: tests of the reported values and of the accuracy.

use constraints::Unconstrained;
use demo_gen::{Grasp, GraspStart, UpperBody};
use kinematics::{KinematicsError, LinkId, Workspace};
use motion::Trajectory;
use nalgebra::{DMatrix, DVector, DVectorView, Vector3};
use playback::{JointPath, PalmTracking, PlaybackError};
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

const UPPER_BODY: &str = include_str!("../../../../robots/asimo_upper_body.urdf");
const UPPER_BODY_SRDF: &str = include_str!("../../../../robots/asimo_upper_body.srdf");

fn upper_body() -> UpperBody {
    UpperBody::new(UPPER_BODY, UPPER_BODY_SRDF).expect("the project's own robot")
}

/// The distance of each palm from its target, recomputed by forward kinematics.
fn literal_errors(body: &UpperBody, path: &JointPath, palms: &Trajectory) -> DMatrix<f64> {
    DMatrix::from_fn(2, palms.n_samples(), |hand, sample| {
        let reached = body.palms(path.configurations.column(sample)).expect("a path of this body")[hand];
        (reached.coords - palms.state(sample).fixed_rows::<3>(3 * hand)).norm()
    })
}

/// The recomputed clearance of each configuration; it is 0 exactly if links collide.
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

/// Largest motion of a joint from one sample to the next, radians or metres.
fn largest_step(path: &JointPath) -> f64 {
    let steps = path.configurations.ncols() - 1;
    (path.configurations.columns(1, steps) - path.configurations.columns(0, steps)).amax()
}

/// The pairs of links that touch, sample by sample.
fn touching(body: &UpperBody, path: &JointPath) -> Vec<Vec<(LinkId, LinkId)>> {
    let mut workspace = Workspace::new();
    let pairs = |q: DVectorView<'_, f64>| {
        let poses = body.robot().forward_kinematics(q, &mut workspace).expect("a path of this body");
        body.collision().colliding_pairs(&poses)
    };
    path.configurations.column_iter().map(pairs).collect()
}

/// Any posture within the joints' limits, in collision or not, and palms that move straight between random places: within
/// reach, out of reach, or through the body.
fn anything(body: &UpperBody, rng: &mut ChaCha8Rng) -> (DVector<f64>, Trajectory) {
    let joints = body.robot().joints();
    let posture = DVector::from_fn(joints.len(), |at, _| rng.random_range(joints[at].lower()..joints[at].upper()));
    let places = DMatrix::from_fn(6, 4, |row, _| match row % 3 {
        0 => rng.random_range(-0.5..1.2f64),
        1 => rng.random_range(-0.8..0.8),
        _ => rng.random_range(0.0..1.8),
    });
    let palms = DMatrix::from_fn(6, 16, |row, sample| {
        let (place, part) = (sample / 5, (sample % 5) as f64 / 5.0);
        places[(row, place)] * (1.0 - part) + places[(row, (place + 1).min(3))] * part
    });
    (posture, Trajectory::new(palms, 0.5).expect("sixteen samples"))
}

/// Checks limits, stride and new contacts of a path, and recomputes errors and clearances.
fn assert_keeps_its_word(body: &UpperBody, tracking: PalmTracking, posture: &DVector<f64>, palms: &Trajectory) {
    let path = tracking.follow(body, palms, posture.as_view()).expect("palms of this body");
    assert_eq!(path.configurations.column(0), posture.column(0));
    for q in path.configurations.column_iter() {
        assert_eq!(body.robot().n_beyond_limits(q).expect("a path of this body"), 0);
    }
    assert!(largest_step(&path) <= tracking.stride + 1e-12, "{}", largest_step(&path));
    for pair in touching(body, &path).windows(2) {
        assert!(pair[1].iter().all(|touching| pair[0].contains(touching)), "{:?} after {:?}", pair[1], pair[0]);
    }
    assert!((literal_errors(body, &path, palms) - &path.errors).amax() < 1e-14);
    assert_eq!(literal_clearances(body, &path), path.clearances);
}

prop_compose! {
    fn any_tracking()(
        damping in 0.001..0.2f64, pull in 0.0..0.5f64, clearance in 0.0..0.03f64, corrections in 1..8usize,
        stride in 0.01..1.0f64,
    ) -> PalmTracking {
        PalmTracking { damping, pull, clearance, corrections, stride }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn demonstrations_keep_limits_and_report_errors(seed in any::<u64>(), tracking in any_tracking()) {
        let grasp = Grasp::new(upper_body());
        let start = grasp.start(&mut ChaCha8Rng::seed_from_u64(seed)).unwrap();
        let recording = grasp.movement(&start).unwrap();
        assert_keeps_its_word(&grasp.body, tracking, &start.posture, &recording.observed);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn random_movements_keep_limits_and_report_errors(seed in any::<u64>(), tracking in any_tracking()) {
        let body = upper_body();
        let (posture, palms) = anything(&body, &mut ChaCha8Rng::seed_from_u64(seed));
        assert_keeps_its_word(&body, tracking, &posture, &palms);
    }
}

/// The palms' unconstrained path to the ball, with random bows of up to 6 cm, which also change the ends.
fn bowed(grasp: &Grasp, start: &GraspStart, rng: &mut ChaCha8Rng) -> Trajectory {
    let free = Unconstrained { dim: 6 };
    let straight = grasp.roll_out.record(&grasp.scene.potential(), &free, start.palms.as_view());
    let straight = straight.expect("nothing is in the way").observed;
    let mut draw = || rng.random_range(-1.0..1.0f64);
    let bows = DMatrix::from_fn(6, 3, |_, _| draw());
    let bowed = DMatrix::from_fn(6, straight.n_samples(), |row, sample| {
        let part = 1.0 - 0.95f64.powf(sample as f64);
        let bow = |waves: f64| (part * waves * std::f64::consts::PI).sin();
        // The ends differ only in y and z, because the ball is at the edge of reach.
        let end = if row % 3 == 0 { 0.0 } else { part * bows[(row, 2)] };
        straight.state(sample)[row] + 0.06 * (bows[(row, 0)] * bow(1.0) + 0.5 * bows[(row, 1)] * bow(2.0) + end)
    });
    Trajectory::new(bowed, 0.5).expect("two samples or more")
}

/// Whether the joints can keep all links apart. Hands are 3.5 cm thick, and the palms' targets may be nearer to a leg or
/// to each other than that.
fn is_possible(palms: &Trajectory) -> bool {
    palms.states().column_iter().all(|palms| {
        let [left, right] = [0, 3].map(|at| Vector3::from(palms.fixed_rows::<3>(at)));
        let from_legs = [0.075, -0.075].into_iter().flat_map(|y| {
            [left, right].map(|palm| (palm - Vector3::new(0.05, y, palm.z.clamp(0.08, 0.56))).norm() - 0.055)
        });
        from_legs.fold(f64::INFINITY, f64::min) > 0.0175 && (left - right).norm() > 0.12
    })
}

/// With the defaults the robot follows the palms to within a third of a millimetre, without jerks or self-contact, both
/// for demonstrations and for policies under other constraints.
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
                assert!(largest_step(&path) < 0.3, "{}", largest_step(&path));
            }
        }
    }
    assert!(n_possible > n_paths * 8 / 10, "{n_possible} of {n_paths}");
}

/// The palms of the ready posture, with the left one moving straight to a point, where it stays, (6, 60).
fn left_palm_to(body: &UpperBody, goal: Vector3<f64>) -> Trajectory {
    let [left, right] = body.palms(body.ready().as_view()).expect("a posture of this body").map(|palm| palm.coords);
    let palms = DMatrix::from_fn(6, 60, |row, sample| match row {
        0..3 => left[row] + (goal[row] - left[row]) * (sample as f64 / 39.0).min(1.0),
        _ => right[row - 3],
    });
    Trajectory::new(palms, 0.5).expect("sixty samples")
}

/// An arm stretched towards a target out of reach comes as near as with many more corrections, and rests.
#[test]
fn arms_point_at_unreachable_targets() {
    let body = upper_body();
    for goal in [[0.95, 0.1, 0.9], [0.4, 1.2, 0.9], [0.2, 0.4, 2.2], [3.0, 0.0, 0.0]].map(Vector3::from) {
        let palms = left_palm_to(&body, goal);
        let follow = |tracking: PalmTracking| tracking.follow(&body, &palms, body.ready().as_view()).unwrap();
        let path = follow(PalmTracking::default());
        let patient = follow(PalmTracking { corrections: 300, ..PalmTracking::default() });
        let [missed, least] = [&path, &patient].map(|path| path.errors[(0, 59)]);
        assert!(least > 0.02 && missed < least + 2e-3, "{goal:?}: {missed}, patiently {least}");
        let rest = path.configurations.columns(50, 10) - path.configurations.columns(49, 10);
        assert!(rest.amax() < 0.02, "{goal:?}: {}", rest.amax());
        assert!(path.clearances.min() > 0.0, "{goal:?}");
    }
}

/// A palm with a target inside a leg stops beside it: half a hand is 1.75 cm thick, the leg's radius is 5.5 cm.
#[test]
fn a_palm_stops_before_the_body() {
    let body = upper_body();
    let palms = left_palm_to(&body, Vector3::new(0.05, 0.075, 0.54));
    let path = PalmTracking::default().follow(&body, &palms, body.ready().as_view()).unwrap();
    assert!(path.clearances.min() > 1e-3, "{}", path.clearances.min());
    assert!((0.0725..0.085).contains(&path.errors[(0, 59)]), "{}", path.errors[(0, 59)]);
    assert!(path.errors.row(1).max() < 0.01, "{}", path.errors.row(1).max());
}

/// If a leg blocks the way of a palm, the hand moves around it without contact and returns to its target.
#[test]
fn a_palm_goes_around_the_body() {
    let grasp = Grasp::new(upper_body());
    let mut n_impossible = 0;
    for seed in 1..=5 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        for _ in 0..100 {
            let start = grasp.start(&mut rng).unwrap();
            let palms = grasp.movement(&start).unwrap().observed;
            if is_possible(&palms) {
                continue;
            }
            n_impossible += 1;
            let path = PalmTracking::default().follow(&grasp.body, &palms, start.posture.as_view()).unwrap();
            assert!(path.clearances.min() > 0.0, "{start:?}");
            assert!(path.errors.max() < 0.15, "{}", path.errors.max());
            assert!(path.errors.column(99).max() < 1e-5, "{}", path.errors.column(99));
        }
    }
    assert!(n_impossible >= 4, "{n_impossible}");
}

#[test]
fn bad_input_is_refused() {
    let body = upper_body();
    let palms = |dim| Trajectory::new(DMatrix::zeros(dim, 2), 1.0).unwrap();
    let follow = |tracking: PalmTracking, dim, n_joints| {
        tracking.follow(&body, &palms(dim), DVector::zeros(n_joints).as_view()).unwrap_err()
    };
    let good = PalmTracking::default();
    assert_eq!(follow(good, 3, 22), PlaybackError::Palms { found: 3 });
    for (pull, corrections) in [(-0.1, 1), (1.1, 1), (0.1, 0)] {
        let expected = PlaybackError::Tracking { pull, corrections };
        assert_eq!(follow(PalmTracking { pull, corrections, ..good }, 6, 22), expected);
    }
    for clearance in [-0.001, f64::INFINITY] {
        assert_eq!(follow(PalmTracking { clearance, ..good }, 6, 22), PlaybackError::Clearance { clearance });
    }
    for stride in [0.0, -0.1] {
        assert_eq!(follow(PalmTracking { stride, ..good }, 6, 22), PlaybackError::Stride { stride });
    }
    let nan = follow(PalmTracking { stride: f64::NAN, ..good }, 6, 22);
    assert!(matches!(nan, PlaybackError::Stride { stride } if stride.is_nan()));
    let damping = PlaybackError::Robot(KinematicsError::Damping { damping: -1.0 });
    assert_eq!(follow(PalmTracking { damping: -1.0, ..good }, 6, 22), damping);
    let length = PlaybackError::Robot(KinematicsError::ConfigurationLength { found: 21, expected: 22 });
    assert_eq!(follow(good, 6, 21), length);

    let no_yaw = UpperBody::new(&UPPER_BODY.replace("l_shoulder_yaw\"", "l_twist\""), UPPER_BODY_SRDF);
    let refused = good.follow(&no_yaw.unwrap(), &palms(6), DVector::zeros(22).as_view()).unwrap_err();
    assert!(
        matches!(refused, PlaybackError::Robot(KinematicsError::UnknownJoint { name, .. }) if name == "l_shoulder_yaw")
    );
}
