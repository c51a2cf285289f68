//! The view's own forward kinematics against the library's.

use std::fs;

use kinematics::{RobotModel, Workspace};
use nalgebra::{DVector, Vector3};
use serde_json::Value;

use super::{page, run, view};

#[test]
fn hands_are_where_forward_kinematics_has_them() {
    let Some(mut page) = page() else { return };
    let playback = fs::read_to_string(run().join("figures/grasp_playback.json")).unwrap();
    let playback: Value = serde_json::from_str(&playback).unwrap();
    let robot = RobotModel::from_urdf(include_str!("../../../../robots/asimo_upper_body.urdf")).unwrap();
    let movements = playback["movements"].as_array().unwrap();
    for movement in movements.iter().step_by(5) {
        let choice = ["learner", "constraint", "start"].map(|name| format!("{name}: {}", movement[name]));
        view::<()>(&mut page, &format!("select({{ {} }})", choice.join(", ")));
        let last = movement["joints"].as_array().unwrap().len() - 1;
        for (sample, share) in [(0, 0.0), (7, 0.0), (19, 0.25), (last / 2, 0.5), (last, 0.0)] {
            let [from, to] =
                [sample, (sample + 1).min(last)].map(|row| joints(&robot, &playback, &movement["joints"][row]));
            let expected = hands(&robot, &from.lerp(&to, share));
            view::<()>(&mut page, &format!("seek({sample} + {share})"));
            let shown: [[f64; 3]; 2] = view(&mut page, "hands()");
            for (shown, expected) in shown.into_iter().zip(expected) {
                let apart = (Vector3::from(shown) - expected).norm();
                assert!(apart < 1e-6, "{apart} m apart, {choice:?}, sample {sample} + {share}");
            }
        }
    }
}

/// A row of joint positions in the robot's order.
fn joints(robot: &RobotModel, playback: &Value, row: &Value) -> DVector<f64> {
    let mut q = DVector::zeros(robot.n_joints());
    for (name, value) in playback["robot"]["joints"].as_array().unwrap().iter().zip(row.as_array().unwrap()) {
        q[robot.joint(name.as_str().unwrap()).unwrap()] = value.as_f64().unwrap();
    }
    q
}

/// Where the palms are.
fn hands(robot: &RobotModel, q: &DVector<f64>) -> [Vector3<f64>; 2] {
    let mut workspace = Workspace::new();
    ["l_palm", "r_palm"].map(|palm| {
        let chain = robot.chain(robot.link(palm).unwrap());
        chain.pose(q.as_view(), &mut workspace).unwrap().translation.vector
    })
}
