//! Violations of URDF's rules, one per row, with the error and the link or joint that it must name.
use crate::urdf_text::{LIMIT, joint, robot, robot_of_version, single};
use Element::{Joint, Link, Robot, UnnamedLink};
use kinematics::{Element, KinematicsError, RobotModel, UrdfProblem};

#[test]
#[allow(clippy::too_many_lines, reason = "one table")]
fn broken_rules_are_refused_by_name() {
    let j = || Joint("j".into());
    let z = r#"<axis xyz="0 0 1"/>"#;
    let plain = |name: &str, parent: &str, child: &str| joint(name, "revolute", parent, child, LIMIT);
    let j1 = plain("j1", "a", "b");
    let cases = [
        (
            "axis with NaN",
            single("revolute", &format!(r#"<axis xyz="nan 0 1"/>{LIMIT}"#)),
            j(),
            UrdfProblem::NotFinite { attribute: "axis.xyz", text: "nan".into() },
        ),
        (
            "axis of two numbers",
            single("revolute", &format!(r#"<axis xyz="0 1"/>{LIMIT}"#)),
            j(),
            UrdfProblem::NumberCount { attribute: "axis.xyz", found: 2, expected: 3 },
        ),
        ("axis zero", single("prismatic", &format!(r#"<axis xyz="0 0 0"/>{LIMIT}"#)), j(), UrdfProblem::ZeroAxis),
        (
            "comma",
            single("revolute", &format!(r#"<origin xyz="0,1 0 0"/>{LIMIT}"#)),
            j(),
            UrdfProblem::Number { attribute: "origin.xyz", text: "0,1".into() },
        ),
        (
            "infinite limit",
            single("revolute", r#"<limit lower="-inf" upper="inf"/>"#),
            j(),
            UrdfProblem::NotFinite { attribute: "limit.lower", text: "-inf".into() },
        ),
        (
            "limits inverted",
            single("revolute", r#"<limit lower="1" upper="-1"/>"#),
            j(),
            UrdfProblem::LimitsInverted { lower: 1.0, upper: -1.0 },
        ),
        ("no limit, revolute", single("revolute", z), j(), UrdfProblem::MissingLimit),
        ("no limit, prismatic", single("prismatic", z), j(), UrdfProblem::MissingLimit),
        (
            "no bounds in 1.2",
            robot_of_version("version=\"1.2\"", "a b", &joint("j", "revolute", "a", "b", r#"<limit upper="1"/>"#)),
            j(),
            UrdfProblem::MissingBound { bound: "lower" },
        ),
        ("floating", single("floating", z), j(), UrdfProblem::UnsupportedJoint { kind: "floating" }),
        ("planar", single("planar", z), j(), UrdfProblem::UnsupportedJoint { kind: "planar" }),
        ("unknown type", single("screw", z), j(), UrdfProblem::JointType { found: "screw".into() }),
        (
            "no type",
            robot("a b", r#"<joint name="j"><parent link="a"/><child link="b"/></joint>"#),
            j(),
            UrdfProblem::MissingAttribute { attribute: "joint.type" },
        ),
        (
            "no parent",
            robot("a b", r#"<joint name="j" type="fixed"><child link="b"/></joint>"#),
            j(),
            UrdfProblem::MissingTag { tag: "parent" },
        ),
        (
            "no child",
            robot("a b", r#"<joint name="j" type="fixed"><parent link="b"/></joint>"#),
            j(),
            UrdfProblem::MissingTag { tag: "child" },
        ),
        (
            "unknown child",
            robot("a", &plain("j", "a", "b")),
            j(),
            UrdfProblem::UnknownLink { role: "child", link: "b".into(), near: vec![] },
        ),
        (
            "unknown parent",
            robot("base b", &plain("j", "bse", "b")),
            j(),
            UrdfProblem::UnknownLink { role: "parent", link: "bse".into(), near: vec!["base".into(), "b".into()] },
        ),
        (
            "zero quaternion",
            robot_of_version(
                "version=\"1.1\"",
                "a b",
                &joint("j", "fixed", "a", "b", r#"<origin quat_xyzw="0 0 0 0"/>"#),
            ),
            j(),
            UrdfProblem::ZeroQuaternion,
        ),
        (
            "duplicate joint",
            robot("a b c", &(plain("j", "a", "b") + &plain("j", "b", "c"))),
            j(),
            UrdfProblem::DuplicateName,
        ),
        ("duplicate link", robot("a b b", &plain("j", "a", "b")), Link("b".into()), UrdfProblem::DuplicateName),
        (
            "link without name",
            robot("a b", &format!("<link/>{}", plain("j", "a", "b"))),
            UnnamedLink(2),
            UrdfProblem::MissingAttribute { attribute: "link.name" },
        ),
        (
            "joint without name",
            robot("a b", r#"<joint type="fixed"><parent link="a"/><child link="b"/></joint>"#),
            Element::UnnamedJoint(0),
            UrdfProblem::MissingAttribute { attribute: "joint.name" },
        ),
        (
            "two parents",
            robot("a b c", &(j1.clone() + &plain("j2", "a", "c") + &plain("j3", "b", "c"))),
            Link("c".into()),
            UrdfProblem::TwoParents { first: "j2".into(), second: "j3".into() },
        ),
        (
            "cycle without a root",
            robot("a b", &(j1.clone() + &plain("j2", "b", "a"))),
            Robot,
            UrdfProblem::Cycle { joints: vec!["j1".into(), "j2".into()] },
        ),
        (
            "cycle beside the root, with a tail",
            robot("r a b c", &(plain("tail", "b", "c") + &j1 + &plain("j2", "b", "a"))),
            Robot,
            UrdfProblem::Cycle { joints: vec!["j1".into(), "j2".into()] },
        ),
        (
            "joint from a link to itself",
            robot("r a", &plain("j", "a", "a")),
            Robot,
            UrdfProblem::Cycle { joints: vec!["j".into()] },
        ),
        ("two roots", robot("a b c", &j1), Robot, UrdfProblem::SeveralRoots { roots: vec!["a".into(), "c".into()] }),
        ("empty", robot("", ""), Robot, UrdfProblem::NoLinks),
        (
            "version 2.0",
            robot_of_version("version=\"2.0\"", "a", ""),
            Robot,
            UrdfProblem::Version { found: "2.0".into() },
        ),
        ("not a robot", "<model/>".to_owned(), Robot, UrdfProblem::RootTag { found: "model".into() }),
    ];
    for (odd, text, element, problem) in cases {
        let error = RobotModel::from_urdf(&text).map(|robot| robot.name().to_owned()).unwrap_err();
        assert_eq!(error, KinematicsError::Urdf { element, problem }, "{odd}");
    }
}

#[test]
fn text_that_is_not_xml_is_refused_with_its_line() {
    for (text, fault) in [
        ("", 1),
        ("<robot name=\"r\">\n<link name=\"a\">", 1),
        ("<robot>\n<link a/></robot>", 2),
        ("robot", 1),
        ("<robot>\n</link>", 2),
        ("<!-- \n\n --><?xml?>\n<robot></link>", 4),
        ("<robot><!-- \n</robot>", 2),
    ] {
        match RobotModel::from_urdf(text) {
            Err(KinematicsError::NotXml { line, .. }) => assert_eq!(line, fault, "{text}"),
            other => panic!("{text}: {other:?}"),
        }
    }
}
