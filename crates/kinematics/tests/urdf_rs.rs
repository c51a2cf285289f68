//! Robots read by the crate urdf-rs: the same robots and the same errors as from the text itself.
use crate::random_tree::tree;
use crate::urdf_text::{LIMIT, double, joint, robot, robot_of_version, single};
use kinematics::{Element, KinematicsError, RobotModel, UrdfProblem};
use proptest::prelude::*;
use urdf_rs::{JointLimit, JointType};

fn through_urdf_rs(text: &str) -> Result<RobotModel, KinematicsError> {
    RobotModel::try_from(&urdf_rs::read_from_string(text).unwrap())
}

/// Compares robots to the last bit: names, tree, origins, axes, limits, mimic joints, shapes.
fn same_robot(text: &str) {
    let (ours, theirs) = (RobotModel::from_urdf(text).unwrap(), through_urdf_rs(text).unwrap());
    assert_eq!(format!("{theirs:?}"), format!("{ours:?}"));
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

#[test]
fn every_shape_and_every_version() {
    let shapes = [
        r#"<box size="1 2 3"/>"#,
        r#"<sphere radius="0.1"/>"#,
        r#"<cylinder radius="0.1" length="0.3"/>"#,
        r#"<capsule radius="0.1" length="0.3"/>"#,
        r#"<mesh filename="a.stl"/>"#,
        r#"<mesh filename="a.stl" scale="1 -1 0.001"/>"#,
    ];
    let shapes = shapes.map(|shape| {
        format!(r#"<collision><origin xyz="1 2 3" rpy="0.1 0.2 0.3"/><geometry>{shape}</geometry></collision>"#)
    });
    let text = format!(
        "<robot name=\"r\"><link name=\"a\"><visual><geometry><sphere radius=\"1\"/></geometry></visual>{}</link></robot>",
        shapes.concat()
    );
    same_robot(&text);
    assert_eq!(through_urdf_rs(&text).unwrap().collision_shapes().unwrap().len(), 6);
    let locked = r#"<limit lower="0" upper="0" effort="1" velocity="1"/>"#;
    for version in ["", "version=\"1.0\"", "version=\"1.1\"", "version=\"1.2\""] {
        for inside in [LIMIT, locked, &format!("{LIMIT}<axis xyz=\"0 3 -4\"/>")] {
            same_robot(&robot_of_version(version, "a b", &joint("j", "prismatic", "a", "b", inside)));
        }
    }
    // A quaternion converted to angles and back loses only its last digits.
    let turned = r#"<origin xyz="1 2 3" quat_xyzw="0.1 0.2 0.3 0.4"/>"#;
    let text = robot_of_version("version=\"1.1\"", "a b", &joint("j", "fixed", "a", "b", turned));
    let origin = |robot: RobotModel| robot.attachment(robot.link("b").unwrap()).unwrap().origin.to_homogeneous();
    let (ours, theirs) = (origin(RobotModel::from_urdf(&text).unwrap()), origin(through_urdf_rs(&text).unwrap()));
    assert!((ours - theirs).amax() < 1e-15);
}

/// Faults that urdf-rs accepts are refused with the same errors as for the text.
#[test]
fn the_same_refusals() {
    let limited = |inside: &str| single("revolute", &format!("{LIMIT}{inside}"));
    let fixed = |name: &str, parent: &str, child: &str| joint(name, "fixed", parent, child, "");
    let mimic = |inside: &str| double("revolute", "revolute", inside);
    let texts = [
        robot("", ""),
        robot("a", "").replace("name=\"a\"", "name=\"\""),
        robot_of_version("version=\"2.0\"", "a", ""),
        single("floating", ""),
        single("planar", ""),
        single("spherical", ""),
        single("revolute", ""),
        single("prismatic", ""),
        single("revolute", r#"<limit lower="1" upper="-1" velocity="1"/>"#),
        single("revolute", r#"<limit lower="-inf" upper="1" velocity="1"/>"#),
        robot_of_version("version=\"1.2\"", "a b", &joint("j", "revolute", "a", "b", r#"<limit upper="1"/>"#)),
        robot_of_version("version=\"1.2\"", "a b", &joint("j", "revolute", "a", "b", r#"<limit lower="1"/>"#)),
        limited(r#"<axis xyz="0 0 0"/>"#),
        limited(r#"<axis xyz="NaN 0 1"/>"#),
        limited(r#"<origin xyz="0 inf 0"/>"#),
        limited(r#"<origin xyz="0 0 1e7"/>"#),
        limited(r#"<origin rpy="0 0 -1e7"/>"#),
        mimic(r#"<mimic joint="j1" multiplier="1e300"/>"#),
        mimic(r#"<mimic joint="j1" offset="NaN"/>"#),
        mimic(r#"<mimic joint="j0"/>"#),
        mimic(r#"<mimic joint="j2"/>"#),
        robot("a b", &fixed("", "a", "b")),
        robot("a b c", &(fixed("j", "a", "b") + &fixed("j", "b", "c"))),
        robot("a b b", &fixed("j", "a", "b")),
        robot("a b c", &fixed("j", "a", "b")),
        robot("a b c", &(fixed("j", "a", "c") + &fixed("k", "b", "c"))),
        robot("r a b", &(fixed("j", "a", "b") + &fixed("k", "b", "a"))),
        robot("base b", &fixed("j", "bse", "b")),
    ];
    for text in texts {
        let ours = RobotModel::from_urdf(&text).map(|robot| robot.name().to_owned());
        assert!(ours.is_err(), "{text}");
        assert_eq!(through_urdf_rs(&text).map(|robot| robot.name().to_owned()), ours, "{text}");
    }
    for shape in [
        r#"<sphere radius="-1"/>"#,
        r#"<box size="1 2 NaN"/>"#,
        r#"<cylinder radius="1" length="1e7"/>"#,
        r#"<capsule radius="1" length="-0.5"/>"#,
        r#"<mesh filename="m" scale="1 inf 1"/>"#,
    ] {
        let text = format!(
            "<robot name=\"r\"><link name=\"a\"><collision><geometry>{shape}</geometry></collision></link></robot>"
        );
        let ours = RobotModel::from_urdf(&text).unwrap();
        let theirs = through_urdf_rs(&text).unwrap();
        assert!(ours.collision_shapes().is_err(), "{shape}");
        assert_eq!(theirs.collision_shapes(), ours.collision_shapes(), "{shape}");
    }
}

/// A missing `<limit>` cannot be distinguished from one of zeros; a robot that is locked by mistake is worse than an error.
#[test]
fn a_limit_of_zeros_alone_counts_as_missing() {
    let text = single("revolute", r#"<limit lower="0" upper="0" effort="0" velocity="0"/>"#);
    assert!(RobotModel::from_urdf(&text).is_ok());
    let problem = UrdfProblem::MissingLimit;
    let error = KinematicsError::Urdf { element: Element::Joint("j".into()), problem };
    assert_eq!(through_urdf_rs(&text).unwrap_err(), error);
    let mut read = urdf_rs::read_from_string(&text).unwrap();
    assert_eq!(read.joints[0].limit, JointLimit::default());
    read.joints[0].joint_type = JointType::Continuous;
    assert!(RobotModel::try_from(&read).is_ok());
}

/// Reasons for a separate reader of texts (docs/decisions/kinematics-urdf-reader.md). If one of these results changes, that
/// page must change.
#[test]
fn urdf_rs_differs_from_our_reader() {
    let reads = |text: &str| urdf_rs::read_from_string(text).is_ok();
    let visual = |inside: &str| format!("<robot name=\"r\"><link name=\"a\"><visual>{inside}</visual></link></robot>");
    let sound = [
        visual(r#"<geometry><mesh filename="m"><gz:note/></mesh></geometry>"#),
        visual(r#"<geometry><mesh filename="m"/><note/></geometry>"#),
        visual(r#"<geometry><sphere radius="1"/></geometry><material name="m"><texture/></material>"#),
        single("revolute", r#"<limit lower="0" upper="1"/>"#),
    ];
    for text in sound {
        assert!(RobotModel::from_urdf(&text).is_ok() && !reads(&text), "{text}");
    }
    let faulty = [single("fixed", r#"<origin xyz="0 0 x 0"/>"#), single("revolute", "")];
    for text in faulty {
        assert!(RobotModel::from_urdf(&text).is_err() && reads(&text), "{text}");
    }
    let foreign = robot("a b", &joint("j", "fixed", "a", "b", "")).replace(
        "</robot>",
        "<s:joint xmlns:s=\"s\" name=\"k\" type=\"fixed\"><parent link=\"a\"/><child link=\"b\"/></s:joint></robot>",
    );
    assert_eq!(urdf_rs::read_from_string(&foreign).unwrap().joints.len(), 2);
    assert_eq!(RobotModel::from_urdf(&foreign).unwrap().links().len(), 2);
    // Nearly upright: 4 mrad of pitch are lost.
    let half = (std::f64::consts::FRAC_PI_2 - 0.004) / 2.0;
    let origin = format!(r#"<origin quat_xyzw="0 {} 0 {}"/>"#, half.sin(), half.cos());
    let upright = robot_of_version("version=\"1.1\"", "a b", &joint("j", "fixed", "a", "b", &origin));
    let pitch = urdf_rs::read_from_string(&upright).unwrap().joints[0].origin.rpy[1];
    assert_eq!(pitch, std::f64::consts::FRAC_PI_2);
}
