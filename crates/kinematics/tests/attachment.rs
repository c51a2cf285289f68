//! Composes a robot's poses by hand from its tree.
use crate::random_tree::tree;
use kinematics::{Attachment, JointMotion, MotionKind, RobotModel, Workspace};
use nalgebra::{DVector, IsometryMatrix3, Rotation3, Translation3, Vector3};
use proptest::prelude::*;

/// The joint's motion at a configuration.
fn motion(joint: &JointMotion, q: &DVector<f64>) -> IsometryMatrix3<f64> {
    let value = joint.multiplier * q[joint.column] + joint.offset;
    match joint.kind {
        MotionKind::Rotation => {
            IsometryMatrix3::from_parts(Translation3::identity(), Rotation3::from_axis_angle(&joint.axis, value))
        }
        MotionKind::Translation => {
            IsometryMatrix3::from_parts(Translation3::from(*joint.axis * value), Rotation3::identity())
        }
    }
}

/// All poses, computed from attachments alone.
fn by_hand(robot: &RobotModel, q: &DVector<f64>) -> Vec<IsometryMatrix3<f64>> {
    let links: Vec<_> = robot.links().collect();
    let mut poses: Vec<IsometryMatrix3<f64>> = Vec::new();
    for &link in &links {
        poses.push(match robot.attachment(link) {
            None => IsometryMatrix3::identity(),
            Some(Attachment { parent, origin, joint }) => {
                let parent = poses[links.iter().position(|&link| link == parent).unwrap()];
                parent * origin * joint.map_or(IsometryMatrix3::identity(), |joint| motion(&joint, q))
            }
        });
    }
    poses
}

fn largest_difference(robot: &RobotModel, q: &DVector<f64>) -> f64 {
    let mut workspace = Workspace::new();
    let poses = robot.forward_kinematics(q.as_view(), &mut workspace).unwrap();
    let pairs = robot.links().zip(by_hand(robot, q));
    let difference =
        |(link, pose): (_, IsometryMatrix3<f64>)| poses.pose(link).to_homogeneous() - pose.to_homogeneous();
    pairs.map(|pair| difference(pair).amax()).fold(0.0, f64::max)
}

proptest! {
    #[test]
    fn the_tree_by_hand_is_forward_kinematics(
        (tree, q) in tree().prop_flat_map(|tree| {
            let n = tree.active().len();
            (Just(tree), proptest::collection::vec(-4.0..4.0f64, n))
        }),
    ) {
        let robot = RobotModel::from_urdf(&tree.urdf()).unwrap();
        prop_assert!(largest_difference(&robot, &DVector::from_vec(q.clone())) < 1e-12);
        let q = DVector::from_vec(q);
        let mut workspace = Workspace::new();
        let poses = robot.forward_kinematics(q.as_view(), &mut workspace).unwrap();
        for link in robot.links() {
            let in_parent = robot.parent(link).map(|parent| poses.pose(parent) * poses.pose_in_parent(link).unwrap());
            let difference = |pose: IsometryMatrix3<f64>| (pose.to_homogeneous() - poses.pose(link).to_homogeneous()).amax();
            prop_assert!(in_parent.map_or(link == robot.root(), |pose| difference(pose) < 1e-12));
            let attachment = robot.attachment(link);
            prop_assert_eq!(attachment.as_ref().map(|attachment| attachment.parent), robot.parent(link));
            let Some(joint) = attachment.and_then(|attachment| attachment.joint) else { continue };
            prop_assert!((joint.axis.norm() - 1.0).abs() < 1e-12 && joint.multiplier >= 0.0);
        }
    }

    #[test]
    fn the_upper_body_by_hand_is_forward_kinematics(q in proptest::collection::vec(-2.0..2.0f64, 22)) {
        let robot = RobotModel::from_urdf(include_str!("../../../robots/asimo_upper_body.urdf")).unwrap();
        prop_assert!(largest_difference(&robot, &DVector::from_vec(q)) < 1e-13);
    }
}

/// A joint about −z that is followed with a negative multiplier, and a fixed joint.
#[test]
fn attachment_motions_match_the_urdf() {
    let robot = RobotModel::from_urdf(
        r#"<robot name="r"><link name="a"/><link name="b"/><link name="c"/><link name="d"/>
             <joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 -2"/>
               <origin xyz="1 2 3"/><limit lower="-1" upper="1"/></joint>
             <joint name="k" type="prismatic"><parent link="b"/><child link="c"/><axis xyz="1 0 0"/>
               <limit lower="-1" upper="1"/><mimic joint="j" multiplier="-3" offset="0.5"/></joint>
             <joint name="l" type="fixed"><parent link="c"/><child link="d"/></joint></robot>"#,
    )
    .unwrap();
    let joint = |name: &str| robot.attachment(robot.link(name).unwrap()).unwrap().joint;
    let turn = joint("b").unwrap();
    assert_eq!((turn.kind, *turn.axis, turn.column), (MotionKind::Rotation, -Vector3::z(), 0));
    assert_eq!((turn.multiplier, turn.offset), (1.0, 0.0));
    let slide = joint("c").unwrap();
    assert_eq!((slide.kind, *slide.axis, slide.column), (MotionKind::Translation, -Vector3::x(), 0));
    assert_eq!((slide.multiplier, slide.offset), (3.0, -0.5));
    assert_eq!(joint("d"), None);
    assert_eq!(robot.attachment(robot.root()), None);
    let b = robot.attachment(robot.link("b").unwrap()).unwrap();
    assert_eq!((b.parent, b.origin.translation.vector), (robot.root(), Vector3::new(1.0, 2.0, 3.0)));
}
