//! A second reader of URDF, where a file is sound: both must see the same robot.
#![allow(clippy::unwrap_used, reason = "a robot that does not load fails the test")]

mod random_tree;

use std::collections::HashMap;

use kinematics::{JointKind, RobotModel, Workspace};
use nalgebra::{DVector, Isometry3, Translation3, UnitQuaternion};
use proptest::prelude::*;
use random_tree::tree;
use urdf_rs::JointType;

/// Names, kinds and limits of the active joints, and the poses of all links while every coordinate is 0.
fn same_robot(text: &str) {
    let (ours, theirs) = (RobotModel::from_urdf(text).unwrap(), urdf_rs::read_from_string(text).unwrap());
    let active = theirs.joints.iter().filter(|joint| joint.joint_type != JointType::Fixed && joint.mimic.is_none());
    let active: Vec<_> = active.collect();
    assert_eq!(ours.n_joints(), active.len());
    for (our, their) in ours.joints().iter().zip(active) {
        assert_eq!(our.name(), their.name);
        match our.kind() {
            JointKind::Continuous => assert_eq!(their.joint_type, JointType::Continuous),
            JointKind::Revolute => assert_eq!(their.joint_type, JointType::Revolute),
            JointKind::Prismatic => assert_eq!(their.joint_type, JointType::Prismatic),
        }
        if our.kind() != JointKind::Continuous {
            assert_eq!((our.lower(), our.upper()), (their.limit.lower, their.limit.upper), "{}", their.name);
        }
    }
    // Mimic joints with an offset have moved when all coordinates are 0; leave the links beyond them out.
    let mut poses = HashMap::from([(ours.link_name(ours.root()), Isometry3::identity())]);
    let mut workspace = Workspace::new();
    let zero = DVector::zeros(ours.n_joints());
    let found = ours.forward_kinematics(zero.as_view(), &mut workspace).unwrap();
    for link in ours.links().skip(1) {
        let name = ours.link_name(link);
        let joint = theirs.joints.iter().find(|joint| joint.child.link == name).unwrap();
        assert_eq!(ours.link_name(ours.parent(link).unwrap()), joint.parent.link);
        let ([x, y, z], [roll, pitch, yaw]) = (*joint.origin.xyz, *joint.origin.rpy);
        let turn = UnitQuaternion::from_euler_angles(roll, pitch, yaw);
        let Some(parent) = poses.get(joint.parent.link.as_str()) else { continue };
        if joint.mimic.is_none() {
            let pose = parent * Isometry3::from_parts(Translation3::new(x, y, z), turn);
            assert!((pose.to_homogeneous() - found.pose(link).to_homogeneous()).amax() < 1e-13, "{name}");
            poses.insert(name, pose);
        }
    }
}

#[test]
fn the_robots_of_this_project() {
    same_robot(include_str!("../../../robots/asimo_upper_body.urdf"));
    same_robot(include_str!("../../../robots/planar_three_link.urdf"));
}

proptest! {
    #[test]
    fn random_robots(tree in tree()) {
        same_robot(&tree.urdf());
    }
}
