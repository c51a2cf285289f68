//! The arm and the upper body: random draws, the constraint at every step, and refused input.

use std::f64::consts::PI;

use crate::robots::{THREE_LINK, arm, upper_body};
use constraints::{ConstraintError, PfaffianConstraint as _, PointConstraint};
use demo_gen::{DemoGenError, HandInPlane, Recording, RollOut, Side, ThreeLinkArm, hand_jacobian, n_leaving_limits};
use kinematics::{Chain, KinematicsError, RobotModel, Workspace};
use nalgebra::{DMatrix, DVector, DVectorView, Matrix3, Matrix3xX, SymmetricEigen, Vector3, dmatrix};
use proptest::prelude::*;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

fn rng(seed: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(seed)
}

fn jacobian(chain: &Chain, q: DVectorView<'_, f64>) -> Matrix3xX<f64> {
    let mut jacobian = Matrix3xX::zeros(q.len());
    chain.position_jacobian(q, &mut Workspace::new(), &mut jacobian).expect("a configuration of this robot");
    jacobian
}

/// The direction, within the first `axes` axes, in which a hand moves least in a whole recording, and its motion there
/// relative to its largest: the smallest singular direction of all its velocities.
fn still_direction(recording: &Recording, chain: &Chain, axes: usize) -> (Vector3<f64>, f64) {
    let mut scatter = DMatrix::zeros(axes, axes);
    for (q, u) in recording.truth.states.column_iter().zip(velocities(recording).column_iter()) {
        let velocity = (jacobian(chain, q) * u).rows(0, axes).into_owned();
        scatter += &velocity * velocity.transpose();
    }
    let eigen = SymmetricEigen::new(scatter);
    let (least, most) = (eigen.eigenvalues.imin(), eigen.eigenvalues.amax());
    let mut direction = Vector3::zeros();
    direction.rows_mut(0, axes).copy_from(&eigen.eigenvectors.column(least));
    (direction, (eigen.eigenvalues[least].max(0.0) / most).sqrt())
}

fn velocities(recording: &Recording) -> &DMatrix<f64> {
    recording.observed.velocities().expect("recordings hold velocities")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn the_arms_hand_stays_on_its_line(
        seed in any::<u64>(),
        start_range in 0.1..3.0f64,
        n_trajectories in 1..5usize,
        roll_out in roll_outs(),
        weight in 0.01..0.2f64,
    ) {
        let mut arm = ThreeLinkArm { start_range, n_trajectories, roll_out, ..arm() };
        arm.potential.weight = weight;
        let recordings = arm.record(&mut rng(seed)).unwrap();
        prop_assert_eq!(&recordings, &arm.record(&mut rng(seed)).unwrap());
        prop_assert_eq!(recordings.len(), n_trajectories);
        let hand = arm.robot.chain(arm.robot.link("hand").unwrap());
        for recording in &recordings {
            prop_assert!(recording.truth.states.column(0).amax() <= start_range);
            obeys(recording, &hand, 2, roll_out)?;
            descends(recording, weight, roll_out)?;
            for (q, action) in recording.truth.states.column_iter().zip(recording.truth.actions.column_iter()) {
                prop_assert!((action + 2.0 * weight * q).amax() < 1e-15);
            }
        }
    }

    #[test]
    fn one_of_the_bodys_hands_stays_in_its_plane(
        seed in any::<u64>(),
        start_variance in 0.01..0.3f64,
        n_trajectories in 1..4usize,
        roll_out in roll_outs(),
        centre in -0.5..0.5f64,
    ) {
        let mut scenario = HandInPlane { start_variance, n_trajectories, roll_out, ..HandInPlane::new(upper_body()) };
        scenario.potential.centre.fill(centre);
        let recordings = scenario.record(&mut rng(seed)).unwrap();
        prop_assert_eq!(&recordings, &scenario.record(&mut rng(seed)).unwrap());
        let robot = scenario.body.robot();
        for recording in &recordings {
            let start = recording.truth.states.column(0);
            prop_assert_eq!(robot.n_beyond_limits(start).unwrap(), 0);
            let mut workspace = Workspace::new();
            prop_assert!(!scenario.body.collision().collides(&robot.forward_kinematics(start, &mut workspace).unwrap()));
            let chains = Side::BOTH.map(|side| scenario.body.palm(side));
            let still = chains.map(|chain| still_direction(recording, chain, 3).1);
            obeys(recording, chains[usize::from(still[1] < still[0])], 3, roll_out)?;
            descends(recording, 0.05, roll_out)?;
        }
        let leaving = recordings.iter().filter(|recording| {
            recording.truth.states.column_iter().any(|q| robot.n_beyond_limits(q).unwrap() > 0)
        });
        prop_assert_eq!(n_leaving_limits(robot, &recordings).unwrap(), leaving.count());
    }
}

fn roll_outs() -> impl Strategy<Value = RollOut> {
    (0.05..0.5f64, 5..30usize, 1..4usize).prop_map(|(time_step, n_samples, sub_steps)| RollOut {
        time_step,
        n_samples,
        sub_steps,
    })
}

/// A u = 0 at every sample, with A = nᵀJ for one n and rank one everywhere; nothing else is forbidden.
fn obeys(recording: &Recording, hand: &Chain, axes: usize, roll_out: RollOut) -> Result<(), TestCaseError> {
    let (normal, _) = still_direction(recording, hand, axes);
    let truth = &recording.truth;
    prop_assert_eq!(truth.states.ncols(), roll_out.n_samples);
    prop_assert_eq!(recording.observed.time_step(), roll_out.time_step);
    for sample in 0..roll_out.n_samples {
        let (q, u) = (truth.states.column(sample), velocities(recording).column(sample));
        let a = normal.transpose() * jacobian(hand, q);
        prop_assert!((&a * u)[0].abs() < 1e-9, "{} at sample {sample}", (&a * u)[0]);
        prop_assert_eq!(truth.projectors[sample].rank(), 1);
        // N π by the explicit formula for one row.
        let action = truth.actions.column(sample);
        let literal = action - a.transpose() * ((&a * action)[0] / a.norm_squared());
        prop_assert!((literal - u).amax() < 1e-6, "sample {sample}");
    }
    Ok(())
}

/// With one Euler step per sample, rule (9) recovers the true potential along the movement, up to its factor 1/(1 −
/// wδt): the step never leaves the constraint, although the constraint turns with the state.
fn descends(recording: &Recording, weight: f64, roll_out: RollOut) -> Result<(), TestCaseError> {
    let (states, potential) = (&recording.truth.states, &recording.truth.potential);
    if roll_out.sub_steps == 1 {
        for sample in 1..roll_out.n_samples {
            let step = (states.column(sample) - states.column(sample - 1)).norm_squared();
            let descent = step / roll_out.time_step * (1.0 - weight * roll_out.time_step);
            prop_assert!((potential[sample - 1] - potential[sample] - descent).abs() < 1e-13 * potential[0]);
        }
    }
    Ok(())
}

/// Each hand has half of the movements, and normals point in all directions.
#[test]
fn sides_and_normals_are_drawn_evenly() {
    let scenario = HandInPlane {
        n_trajectories: 400,
        roll_out: RollOut { n_samples: 6, ..RollOut::default() },
        ..HandInPlane::new(upper_body())
    };
    let mut left = 0;
    let mut spread = Matrix3::zeros();
    for recording in scenario.record(&mut rng(11)).unwrap() {
        let [l, r] = Side::BOTH.map(|side| still_direction(&recording, scenario.body.palm(side), 3));
        left += usize::from(l.1 < r.1);
        let normal = if l.1 < r.1 { l.0 } else { r.0 };
        spread += normal * normal.transpose() / 400.0;
    }
    // Five standard errors of a fair coin, and of n nᵀ on the sphere, whose mean is I/3.
    assert!((left as f64 - 200.0).abs() < 50.0, "{left}");
    assert!((spread - Matrix3::identity() / 3.0).amax() < 5.0 * (4.0_f64 / 45.0 / 400.0).sqrt(), "{spread}");
}

/// Several threads may call one function at the same time.
#[test]
fn a_hands_jacobian_is_that_of_the_robot() {
    let arm = arm();
    let hand = arm.robot.chain(arm.robot.link("hand").unwrap());
    let function = hand_jacobian(&arm.robot, &hand);
    std::thread::scope(|scope| {
        for thread in 0..4 {
            let (function, hand) = (&function, &hand);
            scope.spawn(move || {
                for step in 0..200 {
                    let q = DVector::from_fn(3, |joint, _| PI * ((7 * thread + 3 * step + joint) as f64).sin());
                    let mut filled = DMatrix::zeros(3, 3);
                    function(q.as_view(), filled.as_view_mut()).unwrap();
                    assert_eq!(filled.as_slice(), jacobian(hand, q.as_view()).as_slice());
                }
            });
        }
    });

    let reason = |error: DemoGenError| ConstraintError::Jacobian { reason: error.to_string() };
    let on_a_line = PointConstraint::new(dmatrix![1.0, 0.0], 3, hand_jacobian(&arm.robot, &hand)).unwrap();
    let two_rows = DemoGenError::HandJacobian { found: (2, 3), expected: (3, 3) };
    assert_eq!(on_a_line.null_space_projector(DVector::zeros(3).as_view(), 0.0), Err(reason(two_rows)));
    let other = PointConstraint::new(dmatrix![1.0, 0.0, 0.0], 3, hand_jacobian(&arm.robot, &hand)).unwrap();
    let four_joints = KinematicsError::ConfigurationLength { found: 4, expected: 3 };
    assert_eq!(other.matrix(DVector::zeros(4).as_view(), 0.0), Err(reason(four_joints.into())));
}

#[test]
fn movements_beyond_the_limits_are_counted() {
    let tight = THREE_LINK.replace("3.141592653589793", "0.5");
    let tight = RobotModel::from_urdf(&tight).unwrap();
    let near = ThreeLinkArm { start_range: 0.49, ..arm() }.record(&mut rng(2)).unwrap();
    let far = ThreeLinkArm { start_range: 0.6, ..arm() }.record(&mut rng(2)).unwrap();
    let count = |recordings: &[Recording]| n_leaving_limits(&tight, recordings).unwrap();
    let literal = |recordings: &[Recording]| recordings.iter().filter(|r| r.truth.states.amax() > 0.5).count();
    assert_eq!((count(&near), count(&far)), (literal(&near), literal(&far)));
    assert!(count(&near) < count(&far) && count(&far) < 100);
    assert_eq!(n_leaving_limits(&tight, &[]), Ok(0));
    assert!(matches!(n_leaving_limits(upper_body().robot(), &near), Err(DemoGenError::Robot(_))));
}

#[test]
fn unsuitable_scenarios_are_refused() {
    let refused = |arm: ThreeLinkArm| arm.record(&mut rng(1)).unwrap_err();
    assert_eq!(refused(ThreeLinkArm { n_trajectories: 0, ..arm() }), DemoGenError::NoTrajectory);
    for range in [-1.0, f64::INFINITY] {
        assert_eq!(refused(ThreeLinkArm { start_range: range, ..arm() }), DemoGenError::StartRange { range });
    }
    let roll_out = RollOut { sub_steps: 0, ..RollOut::default() };
    let first = |source| DemoGenError::InTrajectory { trajectory: 0, source: Box::new(source) };
    assert_eq!(refused(ThreeLinkArm { roll_out, ..arm() }), first(DemoGenError::NoSubStep));
    let handless = ThreeLinkArm::new(&THREE_LINK.replace("\"hand\"", "\"hook\"")).unwrap();
    assert!(
        matches!(refused(handless), DemoGenError::Robot(KinematicsError::UnknownLink { name, .. }) if name == "hand")
    );
    assert!(matches!(ThreeLinkArm::new("<robot"), Err(DemoGenError::Robot(KinematicsError::NotXml { .. }))));

    let refused = |scenario: HandInPlane| scenario.record(&mut rng(1)).unwrap_err();
    let scenario = || HandInPlane::new(upper_body());
    assert_eq!(refused(HandInPlane { n_trajectories: 0, ..scenario() }), DemoGenError::NoTrajectory);
    let variance = -0.1;
    assert_eq!(
        refused(HandInPlane { start_variance: variance, ..scenario() }),
        first(DemoGenError::StartVariance { variance })
    );
    assert_eq!(refused(HandInPlane { roll_out, ..scenario() }), first(DemoGenError::NoSubStep));
}
