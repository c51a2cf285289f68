//! After the first call with a workspace, no computation on a configuration allocates.
#![allow(clippy::unwrap_used, reason = "a robot that does not load fails the test")]

use kinematics::{ResolvedRate, RobotModel, SelfCollision, Workspace};
use nalgebra::{DMatrix, DVector, Matrix3xX, Matrix6xX};
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};

fn allocations(mut of: impl FnMut()) -> u64 {
    of(); // The first call may allocate.
    allocation_counter::measure(of).count_total
}

#[test]
fn nothing_is_allocated_per_call() {
    let robot = RobotModel::from_urdf(include_str!("../../../robots/asimo_upper_body.urdf")).unwrap();
    let hand = robot.link("r_palm").unwrap();
    let chain = robot.chain(hand);
    let collision = SelfCollision::new(&robot, |_| None).unwrap();
    let mut control = ResolvedRate::new(0.1).unwrap();
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    let (mut workspace, mut in_chain) = (Workspace::new(), Workspace::new());
    let (mut six, mut three) = (Matrix6xX::zeros(22), Matrix3xX::zeros(22));
    let (mut q, mut velocity) = (robot.random_configuration(&mut rng), DVector::zeros(22));
    let task = DVector::from_column_slice(&[0.1, 0.2, 0.3]);

    assert!(allocations(|| drop(std::hint::black_box(vec![0_u8; 9]))) > 0, "the count is broken");
    assert_eq!(allocations(|| robot.random_configuration_into(&mut rng, q.as_view_mut()).unwrap()), 0);
    let count = allocations(|| {
        let poses = robot.forward_kinematics(q.as_view(), &mut workspace).unwrap();
        poses.jacobian(hand, &mut six).unwrap();
        poses.position_jacobian(hand, &mut three).unwrap();
        std::hint::black_box((poses.pose(hand), collision.collides(&poses), collision.clearance(&poses)));
    });
    assert_eq!(count, 0, "all links");
    let count = allocations(|| {
        chain.jacobian(q.as_view(), &mut in_chain, &mut six).unwrap();
        chain.position_jacobian(q.as_view(), &mut in_chain, &mut three).unwrap();
        std::hint::black_box(chain.pose(q.as_view(), &mut in_chain).unwrap());
    });
    assert_eq!(count, 0, "chain");
    let several = DMatrix::from_fn(22, 11, |joint, index| 0.1 * (joint * index) as f64);
    let mut jacobians = Matrix6xX::zeros(22 * 11);
    let count = allocations(|| {
        robot
            .forward_kinematics_batch(several.as_view(), &mut workspace)
            .unwrap()
            .jacobians(hand, &mut jacobians)
            .unwrap();
        chain.jacobians(several.as_view(), &mut in_chain, &mut jacobians).unwrap();
        std::hint::black_box(chain.poses(several.as_view(), &mut in_chain).unwrap());
        // A single configuration again, in the same workspaces.
        std::hint::black_box(robot.forward_kinematics(q.as_view(), &mut workspace).unwrap().pose(hand));
        std::hint::black_box(chain.pose(q.as_view(), &mut in_chain).unwrap());
    });
    assert_eq!(count, 0, "several configurations");
    let count = allocations(|| {
        control.velocity(&three, task.as_view(), q.as_view(), velocity.as_view_mut()).unwrap();
        robot.clip(q.as_view_mut()).unwrap();
    });
    assert_eq!(count, 0, "resolved rate");
}
