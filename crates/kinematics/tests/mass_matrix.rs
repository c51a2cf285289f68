//! The mass matrix, compared with the kinetic energy of moving links and a formula, and the masses in files.
use kinematics::{Element, KinematicsError, RobotModel, UrdfProblem, Workspace};
use nalgebra::{DMatrix, DVector, IsometryMatrix3, Matrix3, Vector3};
use proptest::prelude::*;

/// Three links that rotate, rotate about a skew axis, and slide; inertials are off the links' frames.
fn arm(inertials: [&str; 3]) -> RobotModel {
    let [a, b, c] = inertials;
    let text = format!(
        r#"<robot name="arm"><link name="base"/><link name="a">{a}</link><link name="b">{b}</link><link name="c">{c}</link>
        <joint name="one" type="continuous"><parent link="base"/><child link="a"/><axis xyz="0 0 1"/></joint>
        <joint name="two" type="continuous"><parent link="a"/><child link="b"/><origin xyz="0.4 0 0.1" rpy="0.3 0.2 0.1"/>
          <axis xyz="1 2 0"/></joint>
        <joint name="three" type="prismatic"><parent link="b"/><child link="c"/><origin xyz="0.3 0 0"/><axis xyz="0 1 1"/>
          <limit lower="-1" upper="1"/></joint></robot>"#
    );
    RobotModel::from_urdf(&text).unwrap()
}

const INERTIALS: [&str; 3] = [
    r#"<inertial><origin xyz="0.2 0.1 0"/><mass value="3"/><inertia ixx="0.02" iyy="0.05" izz="0.06"/></inertial>"#,
    r#"<inertial><origin xyz="0.1 0 0.2" rpy="0.5 0.1 0.7"/><mass value="2"/>
       <inertia ixx="0.03" ixy="0.01" ixz="-0.002" iyy="0.02" iyz="0.004" izz="0.04"/></inertial>"#,
    r#"<inertial><origin xyz="0 0 0.1" rpy="0 1 0"/><mass value="0.5"/><inertia ixx="0.01" iyy="0.02" izz="0.02"/></inertial>"#,
];

fn mass_matrix(robot: &RobotModel, q: &DVector<f64>) -> DMatrix<f64> {
    let mut workspace = Workspace::new();
    robot.forward_kinematics(q.as_view(), &mut workspace).unwrap().mass_matrix().unwrap()
}

/// Poses of the inertial frames.
fn frames(robot: &RobotModel, q: &DVector<f64>) -> Vec<IsometryMatrix3<f64>> {
    let mut workspace = Workspace::new();
    let poses = robot.forward_kinematics(q.as_view(), &mut workspace).unwrap();
    robot.inertials().unwrap().iter().map(|inertial| poses.pose(inertial.link) * inertial.origin).collect()
}

/// ½ Σ m|v|² + ωᵀIω with v and ω from differences of poses.
fn kinetic_energy(robot: &RobotModel, q: &DVector<f64>, velocity: &DVector<f64>) -> f64 {
    let step = 1e-5;
    let (before, after) = (frames(robot, &(q - velocity * step)), frames(robot, &(q + velocity * step)));
    let each = before.iter().zip(&after).zip(robot.inertials().unwrap());
    let energy =
        |((before, after), inertial): ((&IsometryMatrix3<f64>, &IsometryMatrix3<f64>), &kinematics::Inertial)| {
            let v: Vector3<f64> = (after.translation.vector - before.translation.vector) / (2.0 * step);
            let turn: Matrix3<f64> = (before.rotation.inverse() * after.rotation).into_inner() / (2.0 * step);
            let omega = 0.5
                * Vector3::new(turn[(2, 1)] - turn[(1, 2)], turn[(0, 2)] - turn[(2, 0)], turn[(1, 0)] - turn[(0, 1)]);
            0.5 * (inertial.mass * v.norm_squared() + omega.dot(&(inertial.tensor * omega)))
        };
    each.map(energy).sum()
}

proptest! {
    #[test]
    fn kinetic_energy_is_half_of_its_quadratic_form(
        q in prop::array::uniform3(-3.0..3.0f64),
        velocity in prop::array::uniform3(-2.0..2.0f64),
    ) {
        let (robot, q, velocity) = (arm(INERTIALS), DVector::from_row_slice(&q), DVector::from_row_slice(&velocity));
        let mass = mass_matrix(&robot, &q);
        let energy = kinetic_energy(&robot, &q, &velocity);
        prop_assert!((0.5 * velocity.dot(&(&mass * &velocity)) - energy).abs() < 1e-7 * (1.0 + energy));
        prop_assert!((&mass - mass.transpose()).amax() < 1e-14 && mass.clone().cholesky().is_some());
    }

    /// A double pendulum with two point masses at the ends of rods.
    #[test]
    fn a_double_pendulum(q in prop::array::uniform2(-3.0..3.0f64), m in prop::array::uniform2(0.1..5.0f64), l in prop::array::uniform2(0.1..2.0f64)) {
        let link = |mass, length| format!(r#"<inertial><origin xyz="{length} 0 0"/><mass value="{mass}"/></inertial>"#);
        let text = format!(
            r#"<robot name="p"><link name="o"/><link name="a">{}</link><link name="b">{}</link>
            <joint name="1" type="continuous"><parent link="o"/><child link="a"/><axis xyz="0 0 1"/></joint>
            <joint name="2" type="continuous"><parent link="a"/><child link="b"/><origin xyz="{} 0 0"/><axis xyz="0 0 1"/></joint>
            </robot>"#,
            link(m[0], l[0]), link(m[1], l[1]), l[0]
        );
        let found = mass_matrix(&RobotModel::from_urdf(&text).unwrap(), &DVector::from_row_slice(&q));
        let (far, cross) = (m[1] * l[1] * l[1], m[1] * l[0] * l[1] * q[1].cos());
        let near = (m[0] + m[1]) * l[0] * l[0];
        let expected = DMatrix::from_row_slice(2, 2, &[near + far + 2.0 * cross, far + cross, far + cross, far]);
        prop_assert!((found - &expected).amax() < 1e-12 * expected.amax());
    }
}

#[test]
fn links_without_mass_weigh_nothing() {
    let robot = arm(["", "<inertial><mass value=\"0\"/></inertial>", ""]);
    assert!(robot.inertials().unwrap().is_empty());
    assert_eq!(mass_matrix(&robot, &DVector::zeros(3)), DMatrix::zeros(3, 3));
}

#[test]
fn faulty_masses_stop_inertia_alone() {
    let negative = UrdfProblem::NegativeMass { mass: -1.0 };
    let number = UrdfProblem::Number { attribute: "inertia.ixx", text: "x".into() };
    let large = UrdfProblem::TooLarge { attribute: "mass.value", value: 1e7 };
    for (inside, problem) in
        [("<mass value=\"-1\"/>", negative), ("<inertia ixx=\"x\"/>", number), ("<mass value=\"1e7\"/>", large)]
    {
        let robot = arm(["", &format!("<inertial>{inside}</inertial>"), ""]);
        assert_eq!(robot.n_joints(), 3);
        let error = KinematicsError::Urdf { element: Element::Link("b".into()), problem };
        assert_eq!(robot.inertials(), Err(error));
    }
}
