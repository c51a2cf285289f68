use kinematics::{LinkId, Workspace};
use nalgebra::{DVector, Unit, Vector3};

use super::*;
use crate::figures::stage;

#[test]
fn the_document_says_where_the_hands_are() {
    let grasp = grasp().unwrap();
    let robot = grasp.body.robot();
    let playback = grasp_playback(1).unwrap();
    assert_eq!(playback.movements.len(), 3 * 3 * STARTS);
    let links: Vec<LinkId> = robot.links().collect();
    let mut workspace = Workspace::new();
    for movement in &playback.movements {
        let place = format!("{} {} {}", movement.constraint, movement.learner, movement.start);
        assert_eq!((movement.joints.len(), movement.palms.len()), (100, 100), "{place}");
        let mut worst = 0.0_f64;
        for (q, palms) in movement.joints.iter().zip(&movement.palms) {
            let poses = stage::poses(&playback.robot, q);
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
fn the_demonstrated_movements_touch_nothing() {
    let grasp = grasp().unwrap();
    let robot = grasp.body.robot();
    let playback = grasp_playback(1).unwrap();
    let mut workspace = Workspace::new();
    for movement in playback.movements.iter().filter(|m| m.learner == "expert") {
        assert!(movement.error_mm < 1.0, "{} {}: {} mm", movement.constraint, movement.start, movement.error_mm);
        for q in &movement.joints {
            let q = DVector::from_column_slice(q);
            assert_eq!(robot.n_beyond_limits(q.as_view()).unwrap(), 0);
            let poses = robot.forward_kinematics(q.as_view(), &mut workspace).unwrap();
            assert!(!grasp.body.collision().collides(&poses), "{} {}", movement.constraint, movement.start);
        }
    }
}
