//! Queries of a robot: invalid ones return a typed error, valid ones respect the limits.
use crate::random_tree::tree;
use kinematics::{JointKind, KinematicsError, RobotModel, Workspace};
use nalgebra::{DVector, Matrix3xX, Matrix6xX};
use proptest::prelude::*;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};

const UPPER_BODY: &str = include_str!("../../../robots/asimo_upper_body.urdf");

#[test]
fn unknown_names_get_near_ones() {
    let robot = RobotModel::from_urdf(UPPER_BODY).unwrap();
    let error = robot.link("left_palm").unwrap_err();
    assert_eq!(error.to_string(), "the robot has no link \"left_palm\"; did you mean l_palm, r_palm, l_forearm?");
    let near = vec!["l_elbow".to_owned(), "r_elbow".to_owned(), "neck_yaw".to_owned()];
    assert_eq!(robot.joint("L_ELBOW").unwrap_err(), KinematicsError::UnknownJoint { name: "L_ELBOW".into(), near });
    assert!(robot.joint("l_palm_fixed").is_err(), "a fixed joint has no coordinate");
    assert_eq!(robot.joint("l_elbow").unwrap(), 11);
}

#[test]
fn models_can_be_shared_between_threads() {
    fn shared<T: Send + Sync>() {}
    shared::<(RobotModel, kinematics::Chain, kinematics::SelfCollision, Workspace, kinematics::ResolvedRate)>();
}

#[test]
fn bad_configurations_and_jacobians_are_refused_everywhere() {
    let robot = RobotModel::from_urdf(UPPER_BODY).unwrap();
    let hand = robot.link("l_palm").unwrap();
    let chain = robot.chain(hand);
    let mut workspace = Workspace::new();
    let (mut six, mut three) = (Matrix6xX::zeros(22), Matrix3xX::zeros(22));

    let short = DVector::zeros(21);
    let mut broken = DVector::zeros(22);
    broken[11] = f64::NAN;
    broken[20] = f64::INFINITY;
    let length = KinematicsError::ConfigurationLength { found: 21, expected: 22 };
    for (q, expected) in [(short, Some(length)), (broken, None)] {
        let errors = [
            robot.forward_kinematics(q.as_view(), &mut workspace).map(|_| ()).unwrap_err(),
            chain.pose(q.as_view(), &mut workspace).map(|_| ()).unwrap_err(),
            chain.jacobian(q.as_view(), &mut workspace, &mut six).map(|_| ()).unwrap_err(),
            chain.position_jacobian(q.as_view(), &mut workspace, &mut three).map(|_| ()).unwrap_err(),
            robot.n_beyond_limits(q.as_view()).map(|_| ()).unwrap_err(),
            robot.clip(q.clone().as_view_mut()).map(|_| ()).unwrap_err(),
        ];
        for error in errors {
            match &expected {
                Some(expected) => assert_eq!(&error, expected),
                None => assert!(
                    matches!(&error, KinematicsError::NotFinite { joint, index: 11, value }
                        if joint == "l_elbow" && value.is_nan()),
                    "{error:?}"
                ),
            }
        }
    }

    let q = DVector::zeros(22);
    let columns = KinematicsError::JacobianColumns { found: 21, expected: 22 };
    let (mut narrow_six, mut narrow_three) = (Matrix6xX::zeros(21), Matrix3xX::zeros(21));
    let poses = robot.forward_kinematics(q.as_view(), &mut workspace).unwrap();
    assert_eq!(poses.jacobian(hand, &mut narrow_six), Err(columns.clone()));
    assert_eq!(poses.position_jacobian(hand, &mut narrow_three), Err(columns.clone()));
    assert_eq!(chain.jacobian(q.as_view(), &mut workspace, &mut narrow_six), Err(columns.clone()));
    assert_eq!(chain.position_jacobian(q.as_view(), &mut workspace, &mut narrow_three), Err(columns));
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let length = KinematicsError::ConfigurationLength { found: 21, expected: 22 };
    assert_eq!(robot.random_configuration_into(&mut rng, DVector::zeros(21).as_view_mut()), Err(length));
}

proptest! {
    #[test]
    fn limits_hold(tree in tree(), seed in any::<u64>(), spread in 0.0..100.0_f64) {
        let robot = RobotModel::from_urdf(&tree.urdf()).unwrap();
        prop_assert_eq!(robot.n_joints(), tree.active().len());
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let drawn = robot.random_configuration(&mut rng);
        prop_assert_eq!(robot.n_beyond_limits(drawn.as_view()).unwrap(), 0);
        for (value, joint) in drawn.iter().zip(robot.joints()) {
            prop_assert!(joint.kind() != JointKind::Continuous || value.abs() <= std::f64::consts::PI);
        }
        // The same seed gives the same bits from both functions.
        let mut again = DVector::zeros(robot.n_joints());
        robot.random_configuration_into(&mut ChaCha8Rng::seed_from_u64(seed), again.as_view_mut()).unwrap();
        prop_assert_eq!(&again, &drawn);

        let far = drawn.map(|value| value * spread);
        let mut clipped = far.clone();
        let beyond = robot.clip(clipped.as_view_mut()).unwrap();
        prop_assert_eq!(beyond, robot.n_beyond_limits(far.as_view()).unwrap());
        prop_assert_eq!(beyond, far.iter().zip(clipped.iter()).filter(|(a, b)| a != b).count());
        prop_assert_eq!(robot.n_beyond_limits(clipped.as_view()).unwrap(), 0);
    }
}

#[test]
fn draws_fill_the_range_between_limits() {
    let text = r#"<robot name="r"><link name="a"/><link name="b"/><link name="c"/><link name="d"/>
        <joint name="wide" type="prismatic"><parent link="a"/><child link="b"/>
          <limit lower="-1.7e308" upper="1.7e308"/></joint>
        <joint name="locked" type="revolute"><parent link="b"/><child link="c"/>
          <limit lower="0.3" upper="0.3"/></joint>
        <joint name="usual" type="revolute"><parent link="c"/><child link="d"/>
          <limit lower="1" upper="3"/></joint></robot>"#;
    let robot = RobotModel::from_urdf(text).unwrap();
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let draws: Vec<_> = (0..2000).map(|_| robot.random_configuration(&mut rng)).collect();
    assert!(draws.iter().all(|q| q[0].is_finite() && q[1] == 0.3));
    let mean = draws.iter().map(|q| q[2]).sum::<f64>() / 2000.0;
    let (least, most) = draws.iter().fold((f64::MAX, f64::MIN), |(l, m), q| (l.min(q[2]), m.max(q[2])));
    assert!((mean - 2.0).abs() < 0.05 && least < 1.01 && most > 2.99, "{mean} {least} {most}");
}
