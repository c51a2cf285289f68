//! Mimic joints of every kind and in every order, and invalid ones.
use crate::urdf_text::{LIMIT, double, joint, robot};
use kinematics::{Element, KinematicsError, RobotModel, UrdfProblem, Workspace};
use nalgebra::{DVector, Matrix6xX, Rotation3, Vector3};

/// A revolute joint about z; `mimic` holds the attributes of its `<mimic>`, if any.
fn turning(name: &str, parent: &str, child: &str, mimic: &str) -> String {
    let mimic = if mimic.is_empty() { String::new() } else { format!("<mimic {mimic}/>") };
    joint(name, "revolute", parent, child, &format!(r#"<axis xyz="0 0 1"/>{LIMIT}{mimic}"#))
}

#[test]
fn odd_mimic_joints_that_load() {
    const Q: f64 = 0.4;
    let free = |name, parent, child| turning(name, parent, child, "");
    let twice = |of: &str| format!("joint=\"{of}\" multiplier=\"2\"");
    let offset = r#"joint="j1" multiplier="2" offset="0.1""#;
    let thrice = r#"joint="j2" multiplier="3" offset="0.2""#;
    let of_mimic = free("j1", "a", "b") + &turning("j2", "b", "c", offset) + &turning("j3", "c", "d", thrice);
    let upside_down = turning("j1", "a", "b", &twice("j2")) + &free("j2", "b", "c");
    let forward = turning("j2", "b", "c", &twice("j1")) + &free("j1", "a", "b");
    let sibling = turning("ja", "a", "c", &twice("jz")) + &free("jz", "a", "b");
    let sliding = joint("j1", "prismatic", "a", "b", r#"<axis xyz="0 0 1"/><limit lower="-1" upper="2"/>"#);
    let half = |offset: &str| format!(r#"<mimic joint="j1" multiplier="0.5" {offset}/>"#);
    // The robot, the examined link, its angle, and its angular velocity.
    let cases = [
        ("plain", double("revolute", "revolute", &half(r#"offset="0.25""#)), "c", 1.5 * Q + 0.25, 1.5),
        ("no multiplier", double("revolute", "revolute", r#"<mimic joint="j1"/>"#), "c", 2.0 * Q, 2.0),
        ("of a continuous joint", double("continuous", "revolute", &half("")), "c", 1.5 * Q, 1.5),
        (
            "continuous of the same",
            double("continuous", "continuous", &half(r#"offset="0.1""#)),
            "c",
            1.5 * Q + 0.1,
            1.5,
        ),
        ("of a mimic joint", robot("a b c d", &of_mimic), "d", 9.0 * Q + 0.6, 9.0),
        ("of a descendant", robot("a b c", &upside_down), "c", 3.0 * Q, 3.0),
        ("of a joint later in the file", robot("a b c", &forward), "c", 3.0 * Q, 3.0),
        ("of a sibling later in the file", robot("a b c", &sibling), "c", 2.0 * Q, 2.0),
        ("of a slide", robot("a b c", &(sliding + &turning("j2", "b", "c", &twice("j1")))), "c", 2.0 * Q, 2.0),
        ("at a fixed joint, passed over", double("revolute", "fixed", r#"<mimic joint="nobody"/>"#), "c", Q, 1.0),
    ];
    let mut workspace = Workspace::new();
    let mut jacobian = Matrix6xX::zeros(1);
    for (odd, text, link, angle, rate) in cases {
        let robot = RobotModel::from_urdf(&text).unwrap_or_else(|error| panic!("{odd}: {error}"));
        assert_eq!(robot.n_joints(), 1, "{odd}");
        let link = robot.link(link).unwrap();
        let poses = robot.forward_kinematics(DVector::repeat(1, Q).as_view(), &mut workspace).unwrap();
        let difference = poses.pose(link).rotation.matrix() - Rotation3::new(Vector3::z() * angle).matrix();
        assert!(difference.amax() < 1e-14, "{odd}: {difference}");
        poses.jacobian(link, &mut jacobian).unwrap();
        assert!((jacobian[(5, 0)] - rate).abs() < 1e-14, "{odd}: {jacobian}");
    }
}

#[test]
fn mimic_joints_that_follow_nothing_are_refused_by_name() {
    let cases = [
        (
            "mimic of nobody",
            double("revolute", "revolute", r#"<mimic joint="j0"/>"#),
            Element::Joint("j2".into()),
            UrdfProblem::MimicTarget { target: "j0".into(), near: vec!["j1".into(), "j2".into()] },
        ),
        (
            "mimic of a fixed joint",
            double("fixed", "revolute", r#"<mimic joint="j1" offset="0.3"/>"#),
            Element::Joint("j2".into()),
            UrdfProblem::MimicOfFixed { target: "j1".into() },
        ),
        (
            "mimic of itself",
            double("revolute", "revolute", r#"<mimic joint="j2"/>"#),
            Element::Joint("j2".into()),
            UrdfProblem::MimicCycle { path: vec!["j2".into(), "j2".into()] },
        ),
        (
            "mimic in a ring",
            double("revolute", "revolute", r#"<mimic joint="j1"/>"#).replacen(
                LIMIT,
                &format!("{LIMIT}<mimic joint=\"j2\"/>"),
                1,
            ),
            Element::Joint("j1".into()),
            UrdfProblem::MimicCycle { path: vec!["j1".into(), "j2".into(), "j1".into()] },
        ),
        (
            "mimic without a target",
            double("revolute", "revolute", "<mimic/>"),
            Element::Joint("j2".into()),
            UrdfProblem::MissingAttribute { attribute: "mimic.joint" },
        ),
    ];
    for (odd, text, element, problem) in cases {
        let error = RobotModel::from_urdf(&text).map(|robot| robot.name().to_owned()).unwrap_err();
        assert_eq!(error, KinematicsError::Urdf { element, problem }, "{odd}");
    }
}
