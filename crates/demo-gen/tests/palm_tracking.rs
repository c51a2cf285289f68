//! All joints follow a movement of the palms: what is reported is true, and how good it is.

mod robots;

use demo_gen::{DemoGenError, Grasp, JointPath, PalmTracking, UpperBody};
use kinematics::KinematicsError;
use motion::Trajectory;
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use robots::upper_body;

/// The distance of each palm from where it should be, from forward kinematics anew.
fn literal_errors(body: &UpperBody, path: &JointPath, palms: &Trajectory) -> DMatrix<f64> {
    DMatrix::from_fn(2, palms.n_samples(), |hand, sample| {
        let reached = body.palms(path.configurations.column(sample)).expect("a path of this body")[hand];
        (reached.coords - palms.state(sample).fixed_rows::<3>(3 * hand)).norm()
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn the_path_keeps_the_limits_and_tells_its_errors(
        seed in any::<u64>(), damping in 0.001..0.2f64, pull in 0.0..0.5f64, corrections in 1..8usize,
    ) {
        let grasp = Grasp::new(upper_body());
        let start = grasp.start(&mut ChaCha8Rng::seed_from_u64(seed)).unwrap();
        let recording = grasp.movement(&start).unwrap();
        let tracking = PalmTracking { damping, pull, corrections };
        let path = tracking.follow(&grasp.body, &recording.observed, start.posture.as_view()).unwrap();
        prop_assert_eq!(path.configurations.column(0), start.posture.column(0));
        for q in path.configurations.column_iter() {
            prop_assert_eq!(grasp.body.robot().n_beyond_limits(q).unwrap(), 0);
        }
        prop_assert!((literal_errors(&grasp.body, &path, &recording.observed) - &path.errors).amax() < 1e-14);
        prop_assert!(path.errors.column(0).amax() < 1e-14);
    }
}

/// With the defaults the robot carries out what the palms do to within a tenth of a millimetre.
#[test]
fn a_grasp_is_followed_closely() {
    let grasp = Grasp::new(upper_body());
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let mut errors = Vec::new();
    for _ in 0..20 {
        let start = grasp.start(&mut rng).unwrap();
        let recording = grasp.movement(&start).unwrap();
        let path = PalmTracking::default().follow(&grasp.body, &recording.observed, start.posture.as_view()).unwrap();
        errors.extend(path.errors.iter().copied());
    }
    errors.sort_unstable_by(f64::total_cmp);
    let (median, largest) = (errors[errors.len() / 2], errors[errors.len() - 1]);
    assert!(median < 1e-4 && largest < 1e-3, "median {median}, largest {largest}");
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
    let damping = DemoGenError::Robot(KinematicsError::Damping { damping: -1.0 });
    assert_eq!(follow(PalmTracking { damping: -1.0, ..good }, 6, 22), damping);
    let length = DemoGenError::Robot(KinematicsError::ConfigurationLength { found: 21, expected: 22 });
    assert_eq!(follow(good, 6, 21), length);
}
