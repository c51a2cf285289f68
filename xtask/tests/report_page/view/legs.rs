//! Legs are drawn from hips that move with the trunk to feet that stay in place.

use kinematics::{RobotModel, Workspace};
use nalgebra::{DVector, Point3};
use serde_json::Value;

use super::{page, run, view};

#[test]
fn hips_go_with_the_trunk_and_feet_stand() {
    let Some(mut page) = page() else { return };
    let playback = std::fs::read_to_string(run().join("figures/grasp_playback.json")).unwrap();
    let playback: Value = serde_json::from_str(&playback).unwrap();
    let robot = RobotModel::from_urdf(include_str!("../../../../robots/asimo_upper_body.urdf")).unwrap();
    let trunk = robot.chain(robot.link("torso").unwrap());
    let movements = playback["movements"].as_array().unwrap().iter();
    for movement in movements.filter(|movement| movement["constraint"] == "gap" && movement["start"] != 2) {
        let choice = ["learner", "constraint", "start"].map(|name| format!("{name}: {}", movement[name]));
        view::<()>(&mut page, &format!("select({{ {} }})", choice.join(", ")));
        for sample in [0, 20, 50, 99] {
            let mut q = DVector::zeros(robot.n_joints());
            let names = playback["robot"]["joints"].as_array().unwrap();
            for (name, value) in names.iter().zip(movement["joints"][sample].as_array().unwrap()) {
                q[robot.joint(name.as_str().unwrap()).unwrap()] = value.as_f64().unwrap();
            }
            let pose = trunk.pose(q.as_view(), &mut Workspace::new()).unwrap();
            view::<()>(&mut page, &format!("seek({sample})"));
            let limbs: [[[f64; 3]; 3]; 2] = view(&mut page, "limbs()");
            for (limb, side) in limbs.into_iter().zip([0.075, -0.075]) {
                let [ankle, knee, hip] = limb.map(Point3::from);
                assert!((hip - pose * Point3::new(0.0, side, -0.06)).norm() < 1e-6, "{hip}");
                assert!((ankle - Point3::new(0.05, side, 0.08)).norm() < 1e-9, "{ankle}");
                let bones = [(knee - hip).norm(), (ankle - knee).norm()];
                // Both have the same length. If legs are too short, the bones are drawn apart by at most a twentieth.
                assert!((bones[0] - bones[1]).abs() < 1e-9 && (0.264..0.279).contains(&bones[0]), "{bones:?}");
            }
        }
    }
}
