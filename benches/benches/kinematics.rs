//! Forward kinematics and Jacobians of the 22-joint upper body, compared with plain `Isometry3` products.
#![allow(missing_docs, clippy::unwrap_used, reason = "a benchmark that cannot start is no benchmark")]

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use kinematics::{RobotModel, Workspace};
use nalgebra::{DMatrix, DVector, Isometry3, Matrix3xX, Matrix6xX, Translation3, Unit, UnitQuaternion, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use urdf_rs::JointType;

const URDF: &str = include_str!("../../robots/asimo_upper_body.urdf");
const HAND: &str = "l_palm";

/// A straightforward implementation of the upper body: a list of joints, with a product of isometries for each.
struct Plain {
    joints: Vec<PlainJoint>,
    hand: usize,
    poses: Vec<Isometry3<f64>>,
}

struct PlainJoint {
    parent: usize,
    column: Option<usize>,
    slides: bool,
    axis: Unit<Vector3<f64>>,
    origin: Isometry3<f64>,
}

impl Plain {
    fn new() -> Self {
        let urdf = urdf_rs::read_from_string(URDF).unwrap();
        let mut links = vec![String::from("heel")];
        let mut joints = Vec::new();
        let mut column = 0..;
        for joint in &urdf.joints {
            let [x, y, z] = *joint.origin.xyz;
            let [roll, pitch, yaw] = *joint.origin.rpy;
            let fixed = joint.joint_type == JointType::Fixed;
            joints.push(PlainJoint {
                parent: links.iter().position(|link| *link == joint.parent.link).unwrap(),
                column: if fixed { None } else { column.next() },
                slides: joint.joint_type == JointType::Prismatic,
                axis: Unit::new_normalize(Vector3::from(*joint.axis.xyz)),
                origin: Isometry3::from_parts(
                    Translation3::new(x, y, z),
                    UnitQuaternion::from_euler_angles(roll, pitch, yaw),
                ),
            });
            links.push(joint.child.link.clone());
        }
        let hand = links.iter().position(|link| link == HAND).unwrap();
        Plain { poses: vec![Isometry3::identity(); links.len()], joints, hand }
    }

    fn jacobian(&mut self, q: &DVector<f64>, jacobian: &mut Matrix6xX<f64>) {
        for (index, joint) in self.joints.iter().enumerate() {
            let motion = match joint.column {
                None => Isometry3::identity(),
                Some(column) if joint.slides => Translation3::from(joint.axis.into_inner() * q[column]).into(),
                Some(column) => Isometry3::from_parts(
                    Translation3::identity(),
                    UnitQuaternion::from_axis_angle(&joint.axis, q[column]),
                ),
            };
            self.poses[index + 1] = self.poses[joint.parent] * joint.origin * motion;
        }
        jacobian.fill(0.0);
        let tip = self.poses[self.hand].translation.vector;
        let mut link = self.hand;
        while link != 0 {
            let joint = &self.joints[link - 1];
            if let Some(column) = joint.column {
                let axis = self.poses[link] * joint.axis.into_inner();
                if joint.slides {
                    jacobian.fixed_view_mut::<3, 1>(0, column).copy_from(&axis);
                } else {
                    let lever = tip - self.poses[link].translation.vector;
                    jacobian.fixed_view_mut::<3, 1>(0, column).copy_from(&axis.cross(&lever));
                    jacobian.fixed_view_mut::<3, 1>(3, column).copy_from(&axis);
                }
            }
            link = joint.parent;
        }
    }
}

fn upper_body(criterion: &mut Criterion) {
    let robot = RobotModel::from_urdf(URDF).unwrap();
    let hand = robot.link(HAND).unwrap();
    let chain = robot.chain(hand);
    let n = robot.n_joints();
    let (mut six, mut plain_six, mut three) = (Matrix6xX::zeros(n), Matrix6xX::zeros(n), Matrix3xX::zeros(n));
    let mut workspace = Workspace::new();
    let mut plain = Plain::new();

    // Checks first that all give the same result on the same configurations.
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let configurations: Vec<_> = (0..64).map(|_| DVector::from_fn(n, |_, _| rng.random_range(-1.0..1.0))).collect();
    for q in &configurations {
        plain.jacobian(q, &mut plain_six);
        robot.forward_kinematics(q.as_view(), &mut workspace).unwrap().jacobian(hand, &mut six).unwrap();
        chain.position_jacobian(q.as_view(), &mut workspace, &mut three).unwrap();
        assert!((&six - &plain_six).amax() < 1e-14 && (&three - plain_six.fixed_rows::<3>(0)).amax() < 1e-14);
    }
    let together = DMatrix::from_columns(&configurations);
    let mut jacobians = Matrix6xX::zeros(n * configurations.len());
    robot
        .forward_kinematics_batch(together.as_view(), &mut workspace)
        .unwrap()
        .jacobians(hand, &mut jacobians)
        .unwrap();
    for (index, q) in configurations.iter().enumerate() {
        robot.forward_kinematics(q.as_view(), &mut workspace).unwrap().jacobian(hand, &mut six).unwrap();
        assert_eq!(jacobians.columns(index * n, n), six);
    }

    let mut group = criterion.benchmark_group("upper_body");
    let mut cycle = configurations.iter().cycle();
    group.bench_function("all_links_and_jacobian_6x22", |bencher| {
        bencher.iter(|| {
            let q = cycle.next().unwrap();
            robot.forward_kinematics(q.as_view(), &mut workspace).unwrap().jacobian(hand, &mut six).unwrap();
            black_box(&mut six);
        });
    });
    let mut cycle = configurations.iter().cycle();
    group.bench_function("all_links_and_jacobian_6x22_plain_isometry3", |bencher| {
        bencher.iter(|| {
            plain.jacobian(cycle.next().unwrap(), &mut plain_six);
            black_box(&mut plain_six);
        });
    });
    let mut cycle = configurations.iter().cycle();
    group.bench_function("hand_chain_3x22", |bencher| {
        bencher.iter(|| {
            let q = cycle.next().unwrap();
            black_box(chain.position_jacobian(q.as_view(), &mut workspace, &mut three).unwrap());
            black_box(&mut three);
        });
    });
    let mut cycle = configurations.iter().cycle();
    group.bench_function("hand_chain_6x22", |bencher| {
        bencher.iter(|| {
            let q = cycle.next().unwrap();
            black_box(chain.jacobian(q.as_view(), &mut workspace, &mut six).unwrap());
            black_box(&mut six);
        });
    });
    // Times refer to all configurations together, rates to single ones.
    group.throughput(Throughput::Elements(configurations.len() as u64));
    group.bench_function("all_links_and_jacobian_6x22_batch_of_64", |bencher| {
        bencher.iter(|| {
            let poses = robot.forward_kinematics_batch(together.as_view(), &mut workspace).unwrap();
            poses.jacobians(hand, &mut jacobians).unwrap();
            black_box(&mut jacobians);
        });
    });
    group.bench_function("hand_chain_6x22_batch_of_64", |bencher| {
        bencher.iter(|| {
            black_box(chain.jacobians(together.as_view(), &mut workspace, &mut jacobians).unwrap());
            black_box(&mut jacobians);
        });
    });
    group.finish();
}

criterion_group!(benches, upper_body);
criterion_main!(benches);
