use kinematics::{LinkId, Workspace};
use nalgebra::{DVector, Unit, Vector3};
use playback::PalmTracking;

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
            // Each value is rounded by at most half of the last decimal.
            assert!(step <= PalmTracking::default().stride + 1.01e-4, "{place}: {step}");
        }
    }
}
