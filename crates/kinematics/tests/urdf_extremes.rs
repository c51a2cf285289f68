//! Short texts that are slow to read, and finite numbers that overflow in computations: each is read or refused
//! quickly.
use crate::urdf_text::{LIMIT, joint, robot, single};
use cpu_time::ThreadTime;
use kinematics::{Element, KinematicsError, MeshShape, RobotModel, SelfCollision, UrdfProblem, Workspace};
use nalgebra::{DVector, Matrix6xX, Point3};
use proptest::prelude::*;

fn refused(text: &str) -> (Element, UrdfProblem) {
    match RobotModel::from_urdf(text) {
        Err(KinematicsError::Urdf { element, problem }) => (element, problem),
        other => panic!("{other:?}"),
    }
}

#[test]
fn very_long_names_are_not_compared() {
    let [there, asked] = ["a", "b"].map(|letter| letter.repeat(40_000) + "z");
    let text = robot(&format!("{there} x"), &joint("j", "fixed", &asked, "x", ""));
    let problem = UrdfProblem::UnknownLink { role: "parent", link: asked.clone(), near: vec![] };
    assert_eq!(refused(&text), (Element::Joint("j".into()), problem));
    let loaded = RobotModel::from_urdf(&robot(&there, "")).unwrap();
    assert_eq!(loaded.link(&asked).unwrap_err(), KinematicsError::UnknownLink { name: asked, near: vec![] });
}

/// Short entities that stand for long ones can expand a few lines to an enormous text.
#[test]
fn entities_are_refused_wherever_they_are_declared() {
    let declared = |inside: &str| format!("<!DOCTYPE robot [\n{inside}\n]>\n{}", robot("a", ""));
    for entity in ["<!ENTITY e \"x\">", "<!ENTITY % e \"x\">", "<!ENTITY e SYSTEM \"file:///etc/hostname\">"] {
        assert_eq!(refused(&declared(entity)), (Element::Robot, UrdfProblem::Entity { line: 2 }), "{entity}");
    }
    assert!(RobotModel::from_urdf(&declared("<!-- <!ENTITY e \"x\"> -->")).is_ok(), "a comment declares nothing");
    let mut collision = SelfCollision::new(&RobotModel::from_urdf(&robot("a", "")).unwrap(), |_| None).unwrap();
    let srdf = declared("<!ENTITY e \"x\">");
    let error = KinematicsError::Urdf { element: Element::Robot, problem: UrdfProblem::Entity { line: 2 } };
    assert_eq!(collision.disable_srdf(&srdf), Err(error));
}

#[test]
fn tags_of_very_many_attributes_are_refused() {
    let of = |n: usize| {
        let attributes = (0..n).map(|i| format!(" a{i}='\"'")).collect::<Vec<_>>().concat();
        robot("a", &format!("\n<gazebo{attributes}/>"))
    };
    assert_eq!(refused(&of(20_000)), (Element::Robot, UrdfProblem::ManyAttributes { line: 2 }));
    assert_eq!(refused(&of(257)), (Element::Robot, UrdfProblem::ManyAttributes { line: 2 }));
    assert!(RobotModel::from_urdf(&of(256)).is_ok());
    // Texts that only resemble one tag with many attributes.
    let many = "x=\"1\" ".repeat(300);
    for text in [format!("<![CDATA[< {many}]]>"), format!("<?note < {many}?>"), format!("<!-- < {many} -->"), many] {
        assert!(RobotModel::from_urdf(&robot("a", &format!("<note>{text}</note>"))).is_ok());
    }
}

/// A row of prismatic joints along x, in reverse order in the file; with `mimic`, each may follow the one before it.
fn row(n: usize, mimic: impl Fn(usize) -> String) -> String {
    let links: Vec<String> = (0..=n).map(|i| format!("l{i}")).collect();
    let one = |i: usize| {
        let inside = format!("{LIMIT}{}", if i == 0 { String::new() } else { mimic(i - 1) });
        joint(&format!("j{i}"), "prismatic", &links[i], &links[i + 1], &inside)
    };
    let joints: String = (0..n).rev().map(one).collect();
    robot(&links.join(" "), &joints)
}

/// Processor time of this thread, the minimum of three, which is independent of the machine's other load.
fn seconds_to_load(text: &str) -> f64 {
    let load = || {
        let started = ThreadTime::now();
        assert!(RobotModel::from_urdf(text).is_ok());
        started.elapsed().as_secs_f64()
    };
    (0..3).map(|_| load()).fold(f64::INFINITY, f64::min)
}

/// Walking down the chain again for every joint would take 300 times as long.
#[test]
fn a_chain_of_20_000_mimic_joints_takes_as_long_as_as_many_free_ones() {
    const N: usize = 20_000;
    let chain = row(N, |follows| format!(r#"<mimic joint="j{follows}" offset="0.25"/>"#));
    let free = row(N, |_| String::new());
    let [chained, alone] = [&chain, &free].map(|text| seconds_to_load(text));
    assert!(chained < 20.0 * alone, "{chained} s, without mimic {alone} s");
    let robot = RobotModel::from_urdf(&chain).unwrap();
    let mut workspace = Workspace::new();
    let poses = robot.forward_kinematics(DVector::repeat(1, 0.5).as_view(), &mut workspace).unwrap();
    let slides: f64 = (0..N).map(|i| 0.5 + 0.25 * i as f64).sum();
    assert_eq!(poses.position(robot.link(&format!("l{N}")).unwrap()).x, slides);
}

#[test]
fn a_size_of_minus_zero_is_zero() {
    for shape in ["<sphere radius=\"-0\"/>", "<cylinder radius=\"-0\" length=\"1\"/>", "<box size=\"-0 -0 -0\"/>"] {
        let text =
            format!("<robot><link name=\"a\"><collision><geometry>{shape}</geometry></collision></link></robot>");
        let [minus, plus] = [text.clone(), text.replace("-0", "0")].map(|text| RobotModel::from_urdf(&text).unwrap());
        assert_eq!(format!("{:?}", minus.collision_shapes()), format!("{:?}", plus.collision_shapes()), "{shape}");
        assert!(SelfCollision::new(&minus, |_| None).is_ok());
    }
}

#[test]
fn numbers_beyond_a_million_are_refused_where_sums_are_made_of_them() {
    let inside = |tag: &str| single("revolute", &format!("{LIMIT}{tag}"));
    let j = || Element::Joint("j".into());
    let cases = [
        (inside(r#"<origin xyz="1e308 0 0"/>"#), "origin.xyz", 1e308),
        (inside(r#"<origin rpy="0 -1.1e6 0"/>"#), "origin.rpy", -1.1e6),
        (inside(r#"<mimic joint="k" multiplier="1e300"/>"#), "mimic.multiplier", 1e300),
        (inside(r#"<mimic joint="k" offset="-1e7"/>"#), "mimic.offset", -1e7),
    ];
    for (text, attribute, value) in cases {
        assert_eq!(refused(&text), (j(), UrdfProblem::TooLarge { attribute, value }));
    }
    assert!(RobotModel::from_urdf(&inside(r#"<origin xyz="1e6 -1e6 0"/>"#)).is_ok());
    assert!(RobotModel::from_urdf(&single("prismatic", r#"<limit lower="-1e155" upper="1e308"/>"#)).is_ok());
    for (shape, attribute, value) in [
        (r#"<sphere radius="2e6"/>"#, "sphere.radius", 2e6),
        (r#"<box size="1 1e151 1"/>"#, "box.size", 1e151),
        (r#"<capsule radius="1" length="1e300"/>"#, "capsule.length", 1e300),
        (r#"<mesh filename="m" scale="1 1 -1e9"/>"#, "mesh.scale", -1e9),
    ] {
        let text =
            format!("<robot><link name=\"a\"><collision><geometry>{shape}</geometry></collision></link></robot>");
        let (element, problem) = (Element::Link("a".into()), UrdfProblem::TooLarge { attribute, value });
        let robot = RobotModel::from_urdf(&text).unwrap();
        assert_eq!(robot.collision_shapes(), Err(KinematicsError::Urdf { element, problem }), "{shape}");
    }
}

/// Each multiplier is in range, but their product is not.
#[test]
fn mimic_chains_that_multiply_beyond_all_bounds_are_refused() {
    let follows = |name: &str, of: &str, parent: &str, child: &str| {
        joint(name, "revolute", parent, child, &format!(r#"{LIMIT}<mimic joint="{of}" multiplier="1e4" offset="3"/>"#))
    };
    let first = joint("j0", "revolute", "a", "b", LIMIT);
    let text = robot("a b c d", &(first + &follows("j1", "j0", "b", "c") + &follows("j2", "j1", "c", "d")));
    let problem = UrdfProblem::TooLarge { attribute: "mimic.multiplier", value: 1e8 };
    assert_eq!(refused(&text), (Element::Joint("j2".into()), problem));
}

#[test]
fn vertices_beyond_a_million_metres_are_no_mesh() {
    let mesh = r#"<mesh filename="m" scale="1000 1000 1000"/>"#;
    let text = format!("<robot><link name=\"a\"><collision><geometry>{mesh}</geometry></collision></link></robot>");
    let robot = RobotModel::from_urdf(&text).unwrap();
    let hull = |far: f64| {
        let vertices = [[0.0; 3], [far, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Point3::from).to_vec();
        SelfCollision::new(&robot, |_| Some(MeshShape::ConvexHull { vertices: vertices.clone() })).map(|_| ())
    };
    assert_eq!(hull(900.0), Ok(()));
    for far in [1001.0, 1e158, f64::NAN, f64::INFINITY] {
        let reason = "a vertex is not finite, or beyond 1e6 m".to_owned();
        let (link, filename) = ("a".to_owned(), "m".to_owned());
        assert_eq!(hull(far), Err(KinematicsError::BadMesh { link, filename, reason }), "{far}");
    }
}

const FAR_ROBOT: &str = r#"<robot name="far"><link name="a"/><link name="b"/><link name="c"/>
    <joint name="slide" type="prismatic"><parent link="a"/><child link="b"/><origin xyz="1e6 -1e6 1e6" rpy="1 2 3"/>
      <axis xyz="1 2 3"/><limit lower="-1e308" upper="1e308"/></joint>
    <joint name="turn" type="continuous"><parent link="b"/><child link="c"/><origin xyz="1e6 1e6 1e6"/>
      <mimic joint="slide" multiplier="1e6" offset="1e6"/></joint></robot>"#;

#[test]
fn coordinates_too_far_to_be_placed_are_refused() {
    let robot = RobotModel::from_urdf(FAR_ROBOT).unwrap();
    let chain = robot.chain(robot.link("c").unwrap());
    let (mut workspace, mut jacobian) = (Workspace::new(), Matrix6xX::zeros(1));
    for value in [1.1e100, -1e308] {
        let q = DVector::repeat(1, value);
        let error = KinematicsError::TooFar { joint: "slide".into(), index: 0, value };
        assert_eq!(robot.forward_kinematics(q.as_view(), &mut workspace).map(|_| ()), Err(error.clone()));
        assert_eq!(chain.pose(q.as_view(), &mut workspace).map(|_| ()), Err(error.clone()));
        assert_eq!(chain.jacobian(q.as_view(), &mut workspace, &mut jacobian).map(|_| ()), Err(error));
        // Queries of limits still work.
        assert_eq!(robot.n_beyond_limits(q.as_view()), Ok(0));
    }
}

proptest! {
    /// Accepted input has finite poses and Jacobians.
    #[test]
    fn accepted_robots_have_finite_poses_and_jacobians(exponent in -10.0..100.0_f64, negative in any::<bool>()) {
        let robot = RobotModel::from_urdf(FAR_ROBOT).unwrap();
        let value = 10.0_f64.powf(exponent).min(1e100);
        let q = DVector::repeat(1, if negative { -value } else { value });
        let (mut workspace, mut jacobian) = (Workspace::new(), Matrix6xX::zeros(1));
        let poses = robot.forward_kinematics(q.as_view(), &mut workspace).unwrap();
        for link in robot.links() {
            let position = poses.position(link).coords;
            prop_assert!(poses.pose(link).to_homogeneous().iter().all(|entry| entry.is_finite()));
            prop_assert!(position.norm_squared().is_finite());
            poses.jacobian(link, &mut jacobian).unwrap();
            prop_assert!(jacobian.iter().all(|entry| entry.is_finite()), "{}", jacobian);
        }
    }
}
