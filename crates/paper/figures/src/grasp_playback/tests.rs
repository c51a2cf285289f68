use demo_gen::Side;
use experiments::upper_body;
use kinematics::{LinkId, Workspace};
use nalgebra::{DVector, IsometryMatrix3, Translation3, Unit, Vector3};
use playback::PalmTracking;

use super::robot::Motion;
use super::*;
use crate::scene::shapes;

/// Poses of all links in a configuration, from the tree of the document alone, as the script of the page computes them.
fn poses(robot: &Robot, joints: &[f64]) -> Vec<IsometryMatrix3<f64>> {
    let mut poses: Vec<IsometryMatrix3<f64>> = Vec::with_capacity(robot.links.len());
    for link in &robot.links {
        let parent = link.parent.map_or_else(IsometryMatrix3::identity, |parent| poses[parent]);
        let axis = Vector3::from(link.axis);
        let value = link.joint.map_or(0.0, |joint| joints[joint]);
        let moved = match link.motion {
            Motion::Fixed => IsometryMatrix3::identity(),
            Motion::Turn => IsometryMatrix3::rotation(axis * value),
            Motion::Slide => Translation3::from(axis * value).into(),
        };
        poses.push(parent * shapes::pose(&link.translation, &link.rotation) * moved);
    }
    poses
}

#[test]
fn playback_poses_and_errors_match_forward_kinematics() {
    let grasp = grasp().unwrap();
    let robot = grasp.body.robot();
    let playback = grasp_playback(1).unwrap();
    assert_eq!(playback.movements.len(), 3 * LEARNERS.len() * STARTS);
    let links: Vec<LinkId> = robot.links().collect();
    let mut workspace = Workspace::new();
    for movement in &playback.movements {
        let place = format!("{} {} {}", movement.constraint, movement.learner, movement.start);
        assert_eq!((movement.joints.len(), movement.palms.len()), (100, 100), "{place}");
        let mut worst = 0.0_f64;
        for (q, palms) in movement.joints.iter().zip(&movement.palms) {
            let poses = poses(&playback.robot, q);
            let configuration = DVector::from_column_slice(q);
            let expected = robot.forward_kinematics(configuration.as_view(), &mut workspace).unwrap();
            for (pose, link) in poses.iter().zip(&links) {
                assert!((pose.translation.vector - expected.position(*link).coords).norm() < 1e-12, "{place}");
            }
            for (hand, link) in playback.robot.hands.into_iter().enumerate() {
                let wanted = Vector3::from_column_slice(&palms[3 * hand..3 * hand + 3]);
                worst = worst.max((poses[link].translation.vector - wanted).norm());
            }
        }
        assert!(1e3 * worst <= movement.error_mm && movement.error_mm < 1e3 * worst + 2e-3, "{place}: {worst}");
    }
    for link in &playback.robot.links {
        assert!((Unit::new_normalize(Vector3::from(link.axis)).into_inner() - Vector3::from(link.axis)).norm() < 1e-12);
    }
}

#[test]
fn no_movement_touches_or_jumps_and_the_demonstrated_are_exact() {
    let grasp = grasp().unwrap();
    let robot = grasp.body.robot();
    let playback = grasp_playback(1).unwrap();
    let mut workspace = Workspace::new();
    for movement in &playback.movements {
        let place = format!("{} {} {}", movement.constraint, movement.learner, movement.start);
        assert!(movement.learner != "expert" || movement.error_mm < 1.0, "{place}: {} mm", movement.error_mm);
        for q in &movement.joints {
            let q = DVector::from_column_slice(q);
            assert_eq!(robot.n_beyond_limits(q.as_view()).unwrap(), 0);
            let poses = robot.forward_kinematics(q.as_view(), &mut workspace).unwrap();
            assert!(!grasp.body.collision().collides(&poses), "{place}");
        }
        for pair in movement.joints.windows(2) {
            let step = pair[0].iter().zip(&pair[1]).map(|(a, b)| (b - a).abs()).fold(0.0, f64::max);
            // Rounding changes each value by at most half of the last decimal.
            assert!(step <= PalmTracking::default().stride + 1.01e-4, "{place}: {step}");
        }
    }
}

#[test]
fn links_are_where_forward_kinematics_has_them() {
    let body = upper_body().unwrap();
    let tree = robot(&body).unwrap();
    let q =
        DVector::from_fn(body.robot().n_joints(), |i, _| 0.02 * (i as f64 + 1.0) * if i % 2 == 0 { 1.0 } else { -1.0 });
    let poses = poses(&tree, q.as_slice());
    for (side, hand) in Side::BOTH.into_iter().zip(tree.hands) {
        let expected = body.palm(side).pose(q.as_view(), &mut Workspace::new()).unwrap();
        assert!((poses[hand].to_homogeneous() - expected.to_homogeneous()).norm() < 1e-12);
    }
}

#[test]
fn shapes_of_the_tree_are_those_of_the_file() {
    let body = upper_body().unwrap();
    let mut workspace = Workspace::new();
    let expected = body.robot().forward_kinematics(body.ready().as_view(), &mut workspace).unwrap();
    let expected = shapes::posed(body.robot(), &expected).unwrap();
    let tree = robot(&body).unwrap();
    let poses = poses(&tree, body.ready().as_slice());
    assert_eq!(tree.shapes.len(), expected.len());
    for (shape, expected) in tree.shapes.iter().zip(&expected) {
        let pose = poses[shape.link] * shapes::pose(&shape.translation, &shape.rotation);
        let (translation, rotation) = shapes::seen(&pose);
        assert_eq!((tree.links[shape.link].name.as_str(), shape.kind), (expected.link.as_str(), expected.kind));
        assert_eq!(shape.size, expected.size);
        let off = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off(&translation, &expected.translation) < 2e-5 && off(&rotation, &expected.rotation) < 2e-6);
    }
}
