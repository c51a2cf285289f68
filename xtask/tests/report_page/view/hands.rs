//! Compares the view's forward kinematics with the library's.

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
    let shown: Vec<usize> = view(&mut page, "starts()");
    let shown = |movement: &&Value| shown.iter().any(|start| movement["start"] == *start);
    let movements = playback["movements"].as_array().unwrap();
    for movement in movements.iter().filter(shown).step_by(4) {
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

#[test]
fn hands_pass_only_through_a_reported_ball() {
    let Some(mut page) = page() else { return };
    let faults: Vec<String> = page.evaluate(FAULTS);
    assert_eq!(faults, Vec::<String>::new());
}

/// Checks all samples of all movements that can be selected.
const FAULTS: &str = "(() => {
    const { scene: { table, ball, wall }, constraints, learners, movements } =
        JSON.parse(document.getElementById('grasp-playback').textContent);
    const faults = new Set();
    for (const { id: constraint } of constraints) for (const { id: learner, label } of learners) {
        for (const start of policyAlignView.starts()) {
            policyAlignView.select({ constraint, learner, start });
            const { plates, joints } = movements.find((m) => (
                m.constraint === constraint && m.learner === learner && m.start === start
            ));
            const [courses, name] = [[[], []], `${constraint} ${learner} ${start}`];
            for (let sample = 0; sample < joints.length; sample++) {
                policyAlignView.seek(sample);
                policyAlignView.hands().forEach((palm, hand) => courses[hand].push(palm));
            }
            policyAlignView.render();
            const line = document.querySelector('.view-words').textContent.split('\\n').find((l) => l.startsWith(label));
            const deep = courses.flat().some(([x, y, z]) => (
                Math.hypot(x - ball.centre[0], y - ball.centre[1], z - ball.centre[2]) < ball.diameter / 2 - 0.01
            ));
            if (deep !== line.includes('through the ball')) faults.add(`${name}: the ball is not as said`);
            if (deep && ['expert', 'slope_gp'].includes(learner)) faults.add(`${name}: through the ball`);
            for (const course of courses) course.forEach(([x, y, z], i) => {
                const over = x > table.near && x < table.far && Math.abs(y) < table.half_width;
                if (over && z < table.top) faults.add(`${name}: through the table`);
                if (i > 0 && (course[i - 1][0] < wall.x) !== (x < wall.x)) {
                    const through = plates.some(([from, to]) => y > (from ?? -9) && y < (to ?? 9));
                    if (through) faults.add(`${name}: through a plate`);
                }
            });
        }
    }
    return [...faults];
})()";

/// A row of joint positions in the robot's order.
fn joints(robot: &RobotModel, playback: &Value, row: &Value) -> DVector<f64> {
    let mut q = DVector::zeros(robot.n_joints());
    for (name, value) in playback["robot"]["joints"].as_array().unwrap().iter().zip(row.as_array().unwrap()) {
        q[robot.joint(name.as_str().unwrap()).unwrap()] = value.as_f64().unwrap();
    }
    q
}

/// Positions of the palms.
fn hands(robot: &RobotModel, q: &DVector<f64>) -> [Vector3<f64>; 2] {
    let mut workspace = Workspace::new();
    ["l_palm", "r_palm"].map(|palm| {
        let chain = robot.chain(robot.link(palm).unwrap());
        chain.pose(q.as_view(), &mut workspace).unwrap().translation.vector
    })
}
