//! Unusual URDF files that must load, one per row, with the resulting motion.
use std::f64::consts::FRAC_PI_2;

use crate::urdf_text::{LIMIT, ORIGIN, joint, robot, robot_of_version, single};
use kinematics::{Element, JointKind, RobotModel, UrdfWarning, Workspace};
use nalgebra::{DVector, IsometryMatrix3, Rotation3, Translation3, Vector3};

/// The pose of a link with all coordinates at `q`.
fn pose(robot: &RobotModel, link: &str, q: f64) -> IsometryMatrix3<f64> {
    let q = DVector::from_element(robot.n_joints(), q);
    let mut workspace = Workspace::new();
    robot.forward_kinematics(q.as_view(), &mut workspace).unwrap().pose(robot.link(link).unwrap())
}

fn about(axis: [f64; 3], angle: f64) -> Rotation3<f64> {
    Rotation3::new(Vector3::from(axis).normalize() * angle)
}

fn at(xyz: [f64; 3], rotation: Rotation3<f64>) -> IsometryMatrix3<f64> {
    IsometryMatrix3::from_parts(Translation3::from(xyz), rotation)
}

#[test]
#[allow(clippy::too_many_lines, reason = "one table")]
fn odd_single_joints_that_load() {
    const Q: f64 = 0.7;
    let z = |q| at([0.1, 0.0, 0.2], about([0.0, 0.0, 1.0], q));
    let quarter = about([0.0, 0.0, 1.0], FRAC_PI_2);
    let quat = r#"<origin xyz="0.1 0 0.2" rpy="0.3 0 0" quat_xyzw="0 0 2 2"/><axis xyz="0 0 1"/>"#;
    let with_limit = |text: &str| format!("{text}{LIMIT}");
    let versioned = |version: &str, inside: &str| {
        robot_of_version(&format!("version=\"{version}\""), "a b", &joint("j", "revolute", "a", "b", inside))
    };
    let gimbal = Rotation3::from_euler_angles(0.3, FRAC_PI_2, -0.4);
    let cases = [
        ("plain", single("revolute", &format!(r#"{ORIGIN}<axis xyz="0 0 1"/>{LIMIT}"#)), z(Q)),
        ("no axis", single("revolute", &format!("{ORIGIN}{LIMIT}")), at([0.1, 0.0, 0.2], about([1.0, 0.0, 0.0], Q))),
        (
            "axis of length √2",
            single("revolute", &format!(r#"{ORIGIN}<axis xyz="1 1 0"/>{LIMIT}"#)),
            at([0.1, 0.0, 0.2], about([1.0, 1.0, 0.0], Q)),
        ),
        ("axis of length 2", single("revolute", &format!(r#"{ORIGIN}<axis xyz="0 0 2"/>{LIMIT}"#)), z(Q)),
        ("axis backwards", single("revolute", &format!(r#"{ORIGIN}<axis xyz="0 0 -3"/>{LIMIT}"#)), z(-Q)),
        ("tiny axis", single("revolute", &format!(r#"{ORIGIN}<axis xyz="0 0 1e-200"/>{LIMIT}"#)), z(Q)),
        (
            "prismatic, axis of length 2",
            single("prismatic", &format!(r#"{ORIGIN}<axis xyz="0 0 2"/>{LIMIT}"#)),
            at([0.1, 0.0, 0.2 + Q], Rotation3::identity()),
        ),
        ("continuous", single("continuous", &format!(r#"{ORIGIN}<axis xyz="0 0 1"/>"#)), z(Q)),
        (
            "continuous, bounds are passed over",
            single("continuous", &format!(r#"{ORIGIN}<axis xyz="0 0 1"/><limit lower="-inf" upper="x"/>"#)),
            z(Q),
        ),
        ("leading plus", single("revolute", &format!(r#"<origin xyz="+0.1 0 0.2"/><axis xyz="0 0 1"/>{LIMIT}"#)), z(Q)),
        (
            "white space",
            single("revolute", &format!("<origin xyz=\"  0.1\t  0&#10; 0.2 \"/><axis xyz=\"0 0 1\"/>{LIMIT}")),
            z(Q),
        ),
        (
            "no effort, no velocity",
            single("revolute", &format!(r#"{ORIGIN}<axis xyz="0 0 1"/><limit lower="-1" upper="1"/>"#)),
            z(Q),
        ),
        (
            "no origin",
            single("revolute", &format!(r#"<axis xyz="0 0 1"/>{LIMIT}"#)),
            at([0.0; 3], about([0.0, 0.0, 1.0], Q)),
        ),
        (
            "no position",
            single("revolute", &format!(r#"<origin rpy="0 0 0.2"/><axis xyz="0 0 1"/>{LIMIT}"#)),
            at([0.0; 3], about([0.0, 0.0, 1.0], Q + 0.2)),
        ),
        (
            "pitch of a right angle",
            single(
                "revolute",
                &format!(r#"<origin xyz="0.1 0 0.2" rpy="0.3 1.5707963267948966 -0.4"/><axis xyz="0 0 1"/>{LIMIT}"#),
            ),
            at([0.1, 0.0, 0.2], gimbal * about([0.0, 0.0, 1.0], Q)),
        ),
        (
            "joint and link of one name",
            robot("a b", &joint("b", "revolute", "a", "b", &format!(r#"{ORIGIN}<axis xyz="0 0 1"/>{LIMIT}"#))),
            z(Q),
        ),
        (
            "quaternion before 1.1",
            single("revolute", &with_limit(quat)),
            at([0.1, 0.0, 0.2], about([1.0, 0.0, 0.0], 0.3) * about([0.0, 0.0, 1.0], Q)),
        ),
        (
            "quaternion in 1.0",
            versioned("1.0", &with_limit(quat)),
            at([0.1, 0.0, 0.2], about([1.0, 0.0, 0.0], 0.3) * about([0.0, 0.0, 1.0], Q)),
        ),
        (
            "quaternion in 1.1",
            versioned("1.1", &with_limit(quat)),
            at([0.1, 0.0, 0.2], quarter * about([0.0, 0.0, 1.0], Q)),
        ),
        (
            "quaternion in 1.2",
            versioned("1.2", &with_limit(quat)),
            at([0.1, 0.0, 0.2], quarter * about([0.0, 0.0, 1.0], Q)),
        ),
        (
            "foreign tags",
            robot(
                "a b",
                &format!(
                    "<!-- a comment --><gazebo reference=\"a\"><x/></gazebo><transmission name=\"t\">\
                     <joint name=\"j\"/></transmission><ros2_control name=\"x\"/><sim:contact/>{}",
                    joint("j", "revolute", "a", "b", &format!(r#"{ORIGIN}<axis xyz="0 0 1"/><sim:axis/>{LIMIT}"#)),
                ),
            ),
            z(Q),
        ),
        (
            "comments that XML forbids, before the declaration too",
            format!(
                "\u{feff}<!-- -- <robot> -- -->\n<?xml version=\"1.0\"?>\n{}",
                single("revolute", &format!(r#"<!--- a ---->{ORIGIN}<axis xyz="0 0 1"/>{LIMIT}<!-- <limit/> -->"#)),
            ),
            z(Q),
        ),
        (
            "a name space for everything",
            single("revolute", &format!(r#"{ORIGIN}<axis xyz="0 0 1"/>{LIMIT}"#)).replacen(
                "<robot ",
                "<robot xmlns=\"http://www.ros.org\" ",
                1,
            ),
            z(Q),
        ),
        (
            "visual tags that are no URDF",
            format!(
                r#"<robot name="r"><link name="a"><visual><geometry><mesh filename="x"><y/></mesh></geometry>
                   <material name=""><texture/></material></visual></link><link name="b"/>{}</robot>"#,
                joint("j", "revolute", "a", "b", &format!(r#"{ORIGIN}<axis xyz="0 0 1"/>{LIMIT}"#)),
            ),
            z(Q),
        ),
    ];
    for (odd, text, expected) in cases {
        let robot = RobotModel::from_urdf(&text).unwrap_or_else(|error| panic!("{odd}: {error}"));
        let found = pose(&robot, "b", Q);
        assert!((found.to_homogeneous() - expected.to_homogeneous()).amax() < 1e-15, "{odd}: {found} {expected}");
        let ignores_quaternion = odd == "quaternion before 1.1" || odd == "quaternion in 1.0";
        let warning = UrdfWarning::QuaternionIgnored { element: Element::Joint("j".into()) };
        assert_eq!(robot.warnings(), if ignores_quaternion { vec![warning] } else { vec![] }, "{odd}");
    }
}

#[test]
fn odd_limits_that_load() {
    let no_bounds = r#"<limit effort="1" velocity="1"/>"#;
    let old = |version: &str| {
        robot_of_version(&format!("version=\"{version}\""), "a b", &joint("j", "prismatic", "a", "b", no_bounds))
    };
    let cases = [
        (single("revolute", no_bounds), JointKind::Revolute, 0.0, 0.0),
        (old("1.0"), JointKind::Prismatic, 0.0, 0.0),
        (old("1.1"), JointKind::Prismatic, 0.0, 0.0),
        (single("revolute", r#"<limit upper="2"/>"#), JointKind::Revolute, 0.0, 2.0),
        (single("revolute", r#"<limit lower="1" upper="1"/>"#), JointKind::Revolute, 1.0, 1.0),
        (single("continuous", LIMIT), JointKind::Continuous, f64::NEG_INFINITY, f64::INFINITY),
    ];
    for (text, kind, lower, upper) in cases {
        let robot = RobotModel::from_urdf(&text).unwrap();
        let joint = &robot.joints()[0];
        assert_eq!((joint.kind(), joint.lower(), joint.upper()), (kind, lower, upper), "{text}");
    }
}

#[test]
fn a_single_link_is_a_robot_without_joints() {
    let robot = RobotModel::from_urdf(&robot("a", "")).unwrap();
    assert_eq!((robot.n_joints(), robot.links().len(), robot.parent(robot.root())), (0, 1, None));
    assert_eq!(pose(&robot, "a", 0.0), IsometryMatrix3::identity());
}
