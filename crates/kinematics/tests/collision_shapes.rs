//! Collision shapes in a URDF, calls of the mesh resolver, and faults in either.
use crate::two_shapes::{resolver, two_shapes};
use kinematics::{Element, Geometry, KinematicsError, SelfCollision, UrdfProblem};
use nalgebra::Vector3;

#[test]
fn meshes_are_asked_for_only_by_collision() {
    let mesh = |name: &str| format!(r#"<mesh filename="{name}" scale="1 1 1"><foreign/></mesh>"#);
    let new = |first: &str, second: &str| SelfCollision::new(&two_shapes(&mesh(first), &mesh(second)), resolver);
    let missing = KinematicsError::MissingMeshes {
        meshes: vec![("a".into(), "package://gone.stl".into()), ("b".into(), "gone.dae".into())],
    };
    assert_eq!(new("package://gone.stl", "gone.dae").unwrap_err(), missing);
    assert!(missing.to_string().contains("\"gone.dae\" of link \"b\""), "{missing}");
    assert_eq!(new("left out", "hull").unwrap().pairs().count(), 0);
    for bad in ["flat", "no such vertex"] {
        match new("hull", bad).unwrap_err() {
            KinematicsError::BadMesh { link, filename, .. } => {
                assert_eq!((link.as_str(), filename.as_str()), ("b", bad));
            }
            other => panic!("{bad}: {other:?}"),
        }
    }
}

#[test]
fn faulty_shapes_stop_collision_alone() {
    let j = |attribute| UrdfProblem::MissingAttribute { attribute };
    for (shape, problem) in [
        ("", UrdfProblem::UnknownShape),
        ("<cone radius=\"1\"/>", UrdfProblem::UnknownShape),
        ("<sphere/>", j("sphere.radius")),
        ("<mesh/>", j("mesh.filename")),
        ("<sphere radius=\"-1\"/>", UrdfProblem::NegativeSize { attribute: "sphere.radius", value: -1.0 }),
        ("<box size=\"1 2\"/>", UrdfProblem::NumberCount { attribute: "box.size", found: 2, expected: 3 }),
        ("<box size=\"1 2 x\"/>", UrdfProblem::Number { attribute: "box.size", text: "x".into() }),
    ] {
        let robot = two_shapes(shape, "<sphere radius=\"1\"/>");
        assert_eq!(robot.n_joints(), 2);
        let error = KinematicsError::Urdf { element: Element::Link("a".into()), problem };
        assert_eq!(robot.collision_shapes(), Err(error.clone()));
        assert_eq!(SelfCollision::new(&robot, |_| None).unwrap_err(), error);
    }
}

#[test]
fn collision_shapes_match_the_urdf() {
    let robot = two_shapes(r#"<capsule radius="0.1" length="0.8"/>"#, r#"<mesh filename="x" scale="1 2 3"/>"#);
    let shapes = robot.collision_shapes().unwrap();
    assert_eq!(shapes[0].geometry, Geometry::Capsule { radius: 0.1, length: 0.8 });
    assert_eq!(
        (shapes[1].link, &shapes[1].geometry),
        (robot.link("b").unwrap(), &Geometry::Mesh { filename: "x".into(), scale: Vector3::new(1.0, 2.0, 3.0) },)
    );
}
