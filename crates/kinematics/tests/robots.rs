//! The robots of this project agree with their README.
use kinematics::{Geometry, JointKind, RobotModel, SelfCollision, Workspace};
use nalgebra::{DVector, Matrix3xX, Point3};
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};

const UPPER_BODY: &str = include_str!("../../../robots/asimo_upper_body.urdf");
const UPPER_BODY_SRDF: &str = include_str!("../../../robots/asimo_upper_body.srdf");
const THREE_LINK: &str = include_str!("../../../robots/planar_three_link.urdf");

fn upper_body() -> (RobotModel, SelfCollision) {
    let robot = RobotModel::from_urdf(UPPER_BODY).unwrap();
    let mut collision = SelfCollision::new(&robot, |_| None).unwrap();
    collision.disable_srdf(UPPER_BODY_SRDF).unwrap();
    (robot, collision)
}

fn ready(robot: &RobotModel) -> DVector<f64> {
    let mut q = DVector::zeros(robot.n_joints());
    for (joint, value) in [
        ("l_shoulder_pitch", 0.3),
        ("l_shoulder_roll", 0.3),
        ("l_elbow", -1.6),
        ("r_shoulder_pitch", 0.3),
        ("r_shoulder_roll", -0.3),
        ("r_elbow", -1.6),
    ] {
        q[robot.joint(joint).unwrap()] = value;
    }
    q
}

#[test]
fn three_unit_links_in_the_plane() {
    let robot = RobotModel::from_urdf(THREE_LINK).unwrap();
    let hand = robot.chain(robot.link("hand").unwrap());
    let q = DVector::from_column_slice(&[0.3, -0.5, 1.1]);
    let mut jacobian = Matrix3xX::zeros(3);
    let point = hand.position_jacobian(q.as_view(), &mut Workspace::new(), &mut jacobian).unwrap();
    let angles = [0.3, 0.3 - 0.5, 0.3 - 0.5 + 1.1_f64];
    let expected = Point3::new(angles.map(f64::cos).iter().sum(), angles.map(f64::sin).iter().sum(), 0.0);
    assert!((point - expected).norm() < 1e-15);
    for column in 0..3 {
        let dx: f64 = angles[column..].iter().map(|angle| -angle.sin()).sum();
        let dy: f64 = angles[column..].iter().map(|angle| angle.cos()).sum();
        assert!((jacobian.column(column) - nalgebra::Vector3::new(dx, dy, 0.0)).norm() < 1e-15);
    }
}

#[test]
fn the_upper_body_has_22_joints_in_groups() {
    let (robot, _) = upper_body();
    assert_eq!(robot.n_joints(), 22);
    let prefixes = |range: std::ops::Range<usize>, prefix: &str| {
        assert!(robot.joints()[range].iter().all(|joint| joint.name().starts_with(prefix)), "{prefix}");
    };
    prefixes(0..6, "torso_");
    prefixes(6..8, "neck_");
    prefixes(8..15, "l_");
    prefixes(15..22, "r_");
    let sliding = robot.joints().iter().filter(|joint| joint.kind() == JointKind::Prismatic).count();
    assert_eq!(sliding, 3);
    assert!(robot.joints().iter().all(|joint| joint.lower() <= 0.0 && joint.upper() >= 0.0));
}

/// The height and the width over the upper arms given in the README.
#[test]
fn the_upper_body_is_as_large_as_asimo() {
    let (robot, _) = upper_body();
    let mut workspace = Workspace::new();
    let zero = DVector::zeros(22);
    let poses = robot.forward_kinematics(zero.as_view(), &mut workspace).unwrap();
    let mut top: f64 = 0.0;
    let mut width: f64 = 0.0;
    for shape in robot.collision_shapes().unwrap() {
        if let Geometry::Sphere { radius } = shape.geometry {
            let centre = poses.pose(shape.link) * Point3::from(shape.origin.translation.vector);
            top = top.max(centre.z + radius);
            width = width.max(2.0 * (centre.y + radius));
        }
    }
    assert!((top - 1.3).abs() < 1e-12 && (width - 0.45).abs() < 1e-12, "{top} {width}");
}

#[test]
fn hands_hang_at_zero_and_are_in_front_when_ready() {
    let (robot, collision) = upper_body();
    let (left, right) = (robot.link("l_palm").unwrap(), robot.link("r_palm").unwrap());
    let mut workspace = Workspace::new();
    let zero = DVector::zeros(22);
    let poses = robot.forward_kinematics(zero.as_view(), &mut workspace).unwrap();
    assert!((poses.position(left) - Point3::new(0.05, 0.18, 0.44)).norm() < 1e-15);
    assert!((poses.position(right) - Point3::new(0.05, -0.18, 0.44)).norm() < 1e-15);
    assert!(!collision.collides(&poses));

    let q = ready(&robot);
    assert_eq!(robot.n_beyond_limits(q.as_view()).unwrap(), 0);
    let poses = robot.forward_kinematics(q.as_view(), &mut workspace).unwrap();
    assert_eq!(collision.colliding_pairs(&poses), []);
    let (l, r) = (poses.position(left), poses.position(right));
    assert!(l.x > 0.2 && l.z > 0.6 && l.y > 0.18, "{l}");
    assert!((l.x - r.x).abs() < 1e-15 && (l.y + r.y).abs() < 1e-15 && (l.z - r.z).abs() < 1e-15, "{l} {r}");
}

/// The two arms are mirror images: mirrored configurations have mirrored palms and the same collisions.
#[test]
fn left_is_right_in_the_mirror() {
    let (robot, collision) = upper_body();
    let (left, right) = (robot.link("l_palm").unwrap(), robot.link("r_palm").unwrap());
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let (mut here, mut there) = (Workspace::new(), Workspace::new());
    let mut n_colliding = 0;
    for _ in 0..300 {
        let q = robot.random_configuration(&mut rng);
        let mirrored = DVector::from_fn(22, |i, _| {
            let name = robot.joints()[i].name();
            let twin = match name.split_at(2) {
                ("l_", rest) => format!("r_{rest}"),
                ("r_", rest) => format!("l_{rest}"),
                _ => name.to_owned(),
            };
            let value = q[robot.joint(&twin).unwrap()];
            let turns_over = ["torso_y", "roll", "yaw"].iter().any(|part| name.ends_with(part));
            if turns_over { -value } else { value }
        });
        assert_eq!(robot.n_beyond_limits(mirrored.as_view()).unwrap(), 0);
        let poses = robot.forward_kinematics(q.as_view(), &mut here).unwrap();
        let twins = robot.forward_kinematics(mirrored.as_view(), &mut there).unwrap();
        let (palm, twin) = (poses.position(left), twins.position(right));
        assert!((palm - Point3::new(twin.x, -twin.y, twin.z)).norm() < 1e-14, "{palm} {twin}");
        assert_eq!(collision.collides(&poses), collision.collides(&twins), "{q}");
        n_colliding += usize::from(collision.collides(&poses));
    }
    assert!((10..290).contains(&n_colliding), "{n_colliding} of 300 collide: the shapes are off");
}

#[test]
fn only_srdf_pairs_overlap_at_zero() {
    let robot = RobotModel::from_urdf(UPPER_BODY).unwrap();
    let plain = SelfCollision::new(&robot, |_| None).unwrap();
    let names = |(a, b)| (robot.link_name(a), robot.link_name(b));
    let at_zero: Vec<_> = plain.colliding_at_zero(&robot).into_iter().map(names).collect();
    assert_eq!(at_zero, [("heel", "torso"), ("l_forearm", "l_hand"), ("r_forearm", "r_hand")]);
    let (_, collision) = upper_body();
    assert_eq!(collision.colliding_at_zero(&robot), []);
    assert_eq!(plain.pairs().count() - collision.pairs().count(), 4);
}

#[test]
fn hands_that_meet_collide() {
    let (robot, collision) = upper_body();
    let mut q = ready(&robot);
    for (joint, value) in [("l_shoulder_yaw", -1.0), ("r_shoulder_yaw", 1.0)] {
        q[robot.joint(joint).unwrap()] = value;
    }
    let mut workspace = Workspace::new();
    let poses = robot.forward_kinematics(q.as_view(), &mut workspace).unwrap();
    let names = |(a, b)| (robot.link_name(a), robot.link_name(b));
    let pairs: Vec<_> = collision.colliding_pairs(&poses).into_iter().map(names).collect();
    assert!(pairs.contains(&("l_hand", "r_hand")) || pairs.contains(&("l_forearm", "r_forearm")), "{pairs:?}");
}
