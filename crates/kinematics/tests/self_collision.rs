//! Self-collision: distances at known positions, and the pairs that count.
use crate::two_shapes::{resolver, two_shapes};
use kinematics::{Element, KinematicsError, RobotModel, SelfCollision, UrdfProblem, Workspace};
use nalgebra::DVector;

#[test]
fn every_pair_of_shapes_at_a_known_distance() {
    // The shape, and its extent along x.
    let shapes = [
        (r#"<box size="0.4 0.6 0.8"/>"#, 0.2),
        (r#"<sphere radius="0.3"/>"#, 0.3),
        (r#"<cylinder radius="0.25" length="1"/>"#, 0.25),
        (r#"<capsule radius="0.15" length="0.7"/>"#, 0.15),
        (r#"<mesh filename="surface" scale="0.35 0.5 0.5"/>"#, 0.35),
        (r#"<mesh filename="hull" scale="-0.45 0.5 0.5"/>"#, 0.45),
    ];
    let mut workspace = Workspace::new();
    for (first, reach) in shapes {
        for (second, other_reach) in shapes {
            let robot = two_shapes(first, second);
            let collision = SelfCollision::new(&robot, resolver).unwrap();
            for gap in [-0.05, -1e-3, 1e-3, 0.2] {
                let q = DVector::from_column_slice(&[reach + other_reach + gap, 0.0]);
                let poses = robot.forward_kinematics(q.as_view(), &mut workspace).unwrap();
                assert_eq!(collision.collides(&poses), gap < 0.0, "{first} {second} {gap}");
                let clearance = collision.clearance(&poses).unwrap();
                assert!((clearance.distance - gap.max(0.0)).abs() < 1e-7, "{first} {second} {gap} {clearance:?}");
                assert_eq!(clearance.links, (robot.link("a").unwrap(), robot.link("b").unwrap()));
            }
        }
    }
}

/// A cylinder's axis is z: it extends 0.5 up and down, not sideways.
#[test]
fn a_cylinder_is_upright() {
    let shape = r#"<cylinder radius="0.1" length="1"/>"#;
    let robot = RobotModel::from_urdf(&format!(
        r#"<robot name="r"><link name="a"><collision><geometry>{shape}</geometry></collision></link><link name="m"/>
           <link name="b"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
           <joint name="j" type="prismatic"><parent link="a"/><child link="m"/><axis xyz="0 0 1"/>
             <limit lower="-9" upper="9"/></joint>
           <joint name="k" type="prismatic"><parent link="m"/><child link="b"/><limit lower="-9" upper="9"/></joint>
           </robot>"#
    ))
    .unwrap();
    let collision = SelfCollision::new(&robot, |_| None).unwrap();
    let mut workspace = Workspace::new();
    for (z, x, distance) in [(0.8, 0.0, 0.2), (0.4, 0.3, 0.1), (-0.7, 0.0, 0.1)] {
        let q = DVector::from_column_slice(&[z, x]);
        let poses = robot.forward_kinematics(q.as_view(), &mut workspace).unwrap();
        assert!((collision.clearance(&poses).unwrap().distance - distance).abs() < 1e-9);
    }
}

/// A cylinder between two spheres equals the capsule, to the last bit of the closed form.
#[test]
fn a_cylinder_between_two_spheres_is_a_capsule() {
    let tilted = r#"xyz="0.1 0.2 0.3" rpy="0.4 0.5 0.6""#;
    let capsule = two_shapes(r#"<capsule radius="0.1" length="0.8"/>"#, r#"<sphere radius="0.1"/>"#);
    let whole = SelfCollision::new(&capsule, |_| None).unwrap();
    let end = nalgebra::Rotation3::from_euler_angles(0.4, 0.5, 0.6) * nalgebra::Vector3::new(0.0, 0.0, 0.4);
    let at = |sign: f64| format!("{} {} {}", 0.1 + sign * end.x, 0.2 + sign * end.y, 0.3 + sign * end.z);
    let sphere = |sign| {
        format!(r#"<collision><origin xyz="{}"/><geometry><sphere radius="0.1"/></geometry></collision>"#, at(sign))
    };
    let body = |inside: &str| {
        format!(
            r#"<robot name="r"><link name="a">{inside}</link><link name="m"/>
               <link name="b"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
               <joint name="j" type="prismatic"><parent link="a"/><child link="m"/><limit lower="-9" upper="9"/></joint>
               <joint name="k" type="prismatic"><parent link="m"/><child link="b"/><axis xyz="0 1 0"/>
                 <limit lower="-9" upper="9"/></joint></robot>"#
        )
    };
    let of = |shape: &str| format!("<collision><origin {tilted}/><geometry>{shape}</geometry></collision>");
    let three = sphere(1.0) + &of(r#"<cylinder radius="0.1" length="0.8"/>"#) + &sphere(-1.0);
    let three = RobotModel::from_urdf(&body(&three)).unwrap();
    let one = RobotModel::from_urdf(&body(&of(r#"<capsule radius="0.1" length="0.8"/>"#))).unwrap();
    let (in_three, in_one) =
        (SelfCollision::new(&three, |_| None).unwrap(), SelfCollision::new(&one, |_| None).unwrap());
    let (mut here, mut there) = (Workspace::new(), Workspace::new());
    for step in 0..50 {
        let q = DVector::from_column_slice(&[0.02 * f64::from(step), 0.5 - 0.03 * f64::from(step)]);
        let at_three = three.forward_kinematics(q.as_view(), &mut here).unwrap();
        let at_one = one.forward_kinematics(q.as_view(), &mut there).unwrap();
        assert_eq!(in_three.clearance(&at_three), in_one.clearance(&at_one));
        assert_eq!(in_three.collides(&at_three), in_one.collides(&at_one));
    }
    assert_eq!(whole.pairs().count(), 1);
}

/// root – a (fixed) – b (fixed to a) – c (rotates) – d (rotates) – e (fixed to d), all at the same position.
#[test]
fn links_that_cannot_move_or_are_joined_are_no_pair() {
    let shape = r#"<collision><geometry><sphere radius="1"/></geometry></collision>"#;
    let link = |name: &str| format!("<link name=\"{name}\">{shape}</link>");
    let joint = |kind: &str, parent: &str, child: &str| {
        format!(
            r#"<joint name="{parent}{child}" type="{kind}"><parent link="{parent}"/><child link="{child}"/></joint>"#
        )
    };
    let text = format!(
        "<robot name=\"r\"><link name=\"root\"/>{}{}</robot>",
        ["a", "b", "c", "d", "e"].map(link).concat(),
        joint("fixed", "root", "a")
            + &joint("fixed", "a", "b")
            + &joint("continuous", "b", "c")
            + &joint("continuous", "c", "d")
            + &joint("fixed", "d", "e"),
    );
    let robot = RobotModel::from_urdf(&text).unwrap();
    let mut collision = SelfCollision::new(&robot, |_| None).unwrap();
    let pairs = |collision: &SelfCollision| -> Vec<String> {
        collision.pairs().map(|(x, y)| format!("{}{}", robot.link_name(x), robot.link_name(y))).collect()
    };
    assert_eq!(pairs(&collision), ["ad", "ae", "bd", "be"]);
    assert_eq!(collision.colliding_at_zero(&robot).len(), 4);
    collision.disable("d", "a").unwrap();
    assert_eq!(pairs(&collision), ["ae", "bd", "be"]);
    let srdf = r#"<robot name="r"><group name="all"><joint name="x"/></group>
        <disable_collisions link1="b" link2="d" reason="Never"/><disable_collisions link1="b" link2="e"/></robot>"#;
    collision.disable_srdf(srdf).unwrap();
    assert_eq!(pairs(&collision), ["ae"]);
}

#[test]
fn bad_pairs_are_refused() {
    let robot = two_shapes(r#"<sphere radius="1"/>"#, r#"<sphere radius="1"/>"#);
    let mut collision = SelfCollision::new(&robot, |_| None).unwrap();
    let unknown = KinematicsError::UnknownLink { name: "betwen".into(), near: vec!["between".into(), "b".into()] };
    assert_eq!(collision.disable("a", "betwen"), Err(unknown.clone()));
    let srdf = r#"<robot><disable_collisions link1="a" link2="betwen"/></robot>"#;
    assert_eq!(collision.disable_srdf(srdf), Err(unknown.clone()));
    // A valid pair before an invalid one stays a pair.
    let second =
        r#"<robot><disable_collisions link1="b" link2="a"/><disable_collisions link1="a" link2="betwen"/></robot>"#;
    assert_eq!(collision.disable_srdf(second), Err(unknown));
    assert_eq!(collision.pairs().count(), 1);
    let problem = UrdfProblem::MissingAttribute { attribute: "disable_collisions.link2" };
    assert_eq!(
        collision.disable_srdf(r#"<robot><disable_collisions link1="a"/></robot>"#),
        Err(KinematicsError::Urdf { element: Element::Robot, problem })
    );
    assert!(matches!(collision.disable_srdf("<robot>"), Err(KinematicsError::NotXml { .. })));
    assert_eq!(collision.pairs().count(), 1);
}
