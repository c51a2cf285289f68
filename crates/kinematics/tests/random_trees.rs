//! Identities that hold for every robot.
use crate::random_tree::{RandomTree, tree};
use kinematics::{LinkId, RobotModel, Workspace};
use nalgebra::{DVector, Matrix3xX, Matrix6xX, Rotation3, Vector3, Vector6};
use proptest::prelude::*;

/// A tree, a configuration and a velocity of its coordinates (the first n of them), and a link of it.
fn motion() -> impl Strategy<Value = (RandomTree, Vec<f64>, Vec<f64>, usize)> {
    tree().prop_flat_map(|tree| {
        let n = tree.active().len();
        let links = tree.limbs.len() + 1;
        (Just(tree), proptest::collection::vec(-4.0..4.0, n), proptest::collection::vec(-1.0..1.0, n), 0..links)
    })
}

fn link(robot: &RobotModel, index: usize) -> LinkId {
    robot.link(&format!("l{index}")).unwrap()
}

/// Axis times sine of the angle, from the antisymmetric part: exact to second order, whereas an arc cosine loses half
/// of the digits.
fn small_turn(rotation: &Rotation3<f64>) -> Vector3<f64> {
    let r = rotation.matrix();
    Vector3::new(r.m32 - r.m23, r.m13 - r.m31, r.m21 - r.m12) / 2.0
}

proptest! {
    #[test]
    fn poses_are_the_literal_formula((tree, q, _, _) in motion()) {
        let robot = RobotModel::from_urdf(&tree.urdf()).unwrap();
        let names: Vec<String> = tree.active().iter().map(|limb| format!("j{limb}")).collect();
        prop_assert_eq!(robot.joints().iter().map(|joint| joint.name().to_owned()).collect::<Vec<_>>(), names);
        let mut workspace = Workspace::new();
        let poses = robot.forward_kinematics(DVector::from_column_slice(&q).as_view(), &mut workspace).unwrap();
        for index in 0..=tree.limbs.len() {
            let (found, expected) = (poses.pose(link(&robot, index)), tree.pose(index, &q));
            let difference = found.to_homogeneous() - expected.to_homogeneous();
            prop_assert!(difference.amax() < 1e-13, "link {}: {}", index, difference);
            prop_assert_eq!(found.translation.vector, poses.position(link(&robot, index)).coords);
        }
    }

    /// A link's pose relative to its parent does not depend on joints that do not carry it.
    #[test]
    fn poses_compose((tree, q, step, index) in motion()) {
        let robot = RobotModel::from_urdf(&tree.urdf()).unwrap();
        let child = link(&robot, index);
        let Some(parent) = robot.parent(child) else { return Ok(()) };
        let carrier = tree.coordinate_of(index - 1);
        let moved = DVector::from_fn(q.len(), |i, _| if carrier == Some(i) { q[i] } else { q[i] + step[i] });
        let (mut here, mut there) = (Workspace::new(), Workspace::new());
        let at = robot.forward_kinematics(DVector::from_column_slice(&q).as_view(), &mut here).unwrap();
        let moved_at = robot.forward_kinematics(moved.as_view(), &mut there).unwrap();
        let composed = moved_at.pose(parent) * (at.pose(parent).inverse() * at.pose(child));
        prop_assert!((composed.to_homogeneous() - moved_at.pose(child).to_homogeneous()).amax() < 1e-12);
    }

    #[test]
    fn jacobian_times_velocity_is_the_finite_difference((tree, q, velocity, index) in motion()) {
        const H: f64 = 1e-5;
        let robot = RobotModel::from_urdf(&tree.urdf()).unwrap();
        let link = link(&robot, index);
        let mut workspace = Workspace::new();
        let (q, velocity) = (DVector::from_vec(q), DVector::from_vec(velocity));
        let mut pose_at = |t: f64| {
            robot.forward_kinematics((&q + &velocity * t).as_view(), &mut workspace).unwrap().pose(link)
        };
        let (before, after) = (pose_at(-H), pose_at(H));
        let linear = (after.translation.vector - before.translation.vector) / (2.0 * H);
        let angular = small_turn(&(after.rotation * before.rotation.inverse())) / (2.0 * H);
        let mut jacobian = Matrix6xX::zeros(robot.n_joints());
        let poses = robot.forward_kinematics(q.as_view(), &mut workspace).unwrap();
        poses.jacobian(link, &mut jacobian).unwrap();
        let twist: Vector6<f64> = &jacobian * &velocity;
        let scale = 1.0 + twist.amax().powi(3);
        prop_assert!((twist.fixed_rows::<3>(0) - linear).amax() < 1e-8 * scale, "{} {}", twist, linear);
        prop_assert!((twist.fixed_rows::<3>(3) - angular).amax() < 1e-8 * scale, "{} {}", twist, angular);
    }

    #[test]
    fn chain_and_robot_kinematics_agree((tree, q, _, index) in motion()) {
        let robot = RobotModel::from_urdf(&tree.urdf()).unwrap();
        let (link, q) = (link(&robot, index), DVector::from_vec(q));
        let chain = robot.chain(link);
        let n = robot.n_joints();
        // Previous contents of the matrices must not matter.
        let (mut six, mut six_chain) = (Matrix6xX::repeat(n, f64::NAN), Matrix6xX::repeat(n, f64::NAN));
        let (mut three, mut three_chain) = (Matrix3xX::repeat(n, f64::NAN), Matrix3xX::repeat(n, f64::NAN));
        let mut workspace = Workspace::new();

        let poses = robot.forward_kinematics(q.as_view(), &mut workspace).unwrap();
        poses.jacobian(link, &mut six).unwrap();
        poses.position_jacobian(link, &mut three).unwrap();
        let pose = poses.pose(link);
        prop_assert_eq!(&three, &six.fixed_rows::<3>(0).into_owned());

        let reached = chain.jacobian(q.as_view(), &mut workspace, &mut six_chain).unwrap();
        let point = chain.position_jacobian(q.as_view(), &mut workspace, &mut three_chain).unwrap();
        prop_assert_eq!(&three_chain, &six_chain.fixed_rows::<3>(0).into_owned());
        prop_assert_eq!(point.coords, reached.translation.vector);
        prop_assert_eq!(chain.pose(q.as_view(), &mut workspace).unwrap(), reached);

        prop_assert!((&six - &six_chain).amax() < 1e-13 * (1.0 + six.amax()));
        prop_assert!((pose.to_homogeneous() - reached.to_homogeneous()).amax() < 1e-13);
    }
}
