//! Compares the damped resolved-rate step with its definition.
use kinematics::{KinematicsError, ResolvedRate, RobotModel, Workspace};
use nalgebra::{DMatrix, DVector, Matrix3xX};
use proptest::prelude::*;

fn step(damping: f64, j: &DMatrix<f64>, v: &DVector<f64>, z: &DVector<f64>) -> Result<DVector<f64>, KinematicsError> {
    let mut velocity = DVector::repeat(j.ncols(), f64::NAN);
    ResolvedRate::new(damping)?.velocity(j.as_view(), v.as_view(), z.as_view(), velocity.as_view_mut())?;
    Ok(velocity)
}

fn problem() -> impl Strategy<Value = (DMatrix<f64>, DVector<f64>, DVector<f64>, f64)> {
    (1..=9_usize, 9..=22_usize).prop_flat_map(|(m, n)| {
        let vector = |length| proptest::collection::vec(-1.0..1.0, length).prop_map(DVector::from_vec);
        let matrix = proptest::collection::vec(-1.0..1.0, m * n).prop_map(move |v| DMatrix::from_vec(m, n, v));
        (matrix, vector(m), vector(n), 0.01..1.0)
    })
}

proptest! {
    /// q̇ = J⁺ v + (I − J⁺ J) z with J⁺ = Jᵀ (J Jᵀ + λ² I)⁻¹, written out.
    #[test]
    fn is_the_literal_formula((j, v, z, damping) in problem()) {
        let (m, n) = j.shape();
        let gram = &j * j.transpose() + DMatrix::identity(m, m) * damping * damping;
        let pseudo_inverse = j.transpose() * gram.try_inverse().unwrap();
        let expected = &pseudo_inverse * &v + (DMatrix::identity(n, n) - &pseudo_inverse * &j) * &z;
        let found = step(damping, &j, &v, &z).unwrap();
        prop_assert!((&found - &expected).amax() < 1e-8 * (1.0 + expected.amax() / (damping * damping)));
    }

    /// The step is a minimum: no other step has a smaller |J q̇ − v|² + λ² |q̇ − z|².
    #[test]
    fn is_the_minimum((j, v, z, damping) in problem(), way in proptest::collection::vec(-1.0..1.0, 22)) {
        let cost = |q: &DVector<f64>| (&j * q - &v).norm_squared() + damping * damping * (q - &z).norm_squared();
        let found = step(damping, &j, &v, &z).unwrap();
        let beside = &found + DVector::from_column_slice(&way[..j.ncols()]) * 1e-3;
        prop_assert!(cost(&found) <= cost(&beside));
    }
}

#[test]
fn undamped_steps_meet_the_task_exactly() {
    let j = DMatrix::from_fn(3, 7, |i, k| ((3 * i * k + 5 * k + i) as f64).sin());
    let (v, z) = (DVector::from_column_slice(&[0.3, -0.2, 0.5]), DVector::from_fn(7, |k, _| (k as f64).cos()));
    let with = step(0.0, &j, &v, &z).unwrap();
    let without = step(0.0, &j, &v, &DVector::zeros(7)).unwrap();
    assert!((&j * &with - &v).amax() < 1e-13);
    assert!((&j * &without - &v).amax() < 1e-13);
    assert!((&with - &without).amax() > 0.1);
}

#[test]
fn bad_input_is_refused() {
    for damping in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(ResolvedRate::new(damping), Err(KinematicsError::Damping { .. })));
    }
    let (j, v, z) = (DMatrix::identity(3, 5), DVector::zeros(3), DVector::zeros(5));
    let shape = KinematicsError::TaskShape { jacobian: (3, 5), task: 2, pull: 5, velocity: 5 };
    assert_eq!(step(0.1, &j, &DVector::zeros(2), &z), Err(shape));
    let shape = KinematicsError::TaskShape { jacobian: (3, 5), task: 3, pull: 4, velocity: 5 };
    assert_eq!(step(0.1, &j, &v, &DVector::zeros(4)), Err(shape));

    let flat = DMatrix::from_fn(3, 5, |_, k| k as f64);
    assert_eq!(step(0.0, &flat, &v, &z), Err(KinematicsError::SingularTask { damping: 0.0 }));
    assert!(step(0.1, &flat, &v, &z).is_ok());
    // Rounding leaves a nonzero pivot in this matrix.
    let rounded = DMatrix::from_row_slice(2, 3, &[0.1, 0.2, 0.3, 0.5, 1.0, 1.5]);
    let (task, rest) = (DVector::from_vec(vec![1.0, 0.0]), DVector::zeros(3));
    assert_eq!(step(0.0, &rounded, &task, &rest), Err(KinematicsError::SingularTask { damping: 0.0 }));
    assert!(step(1e-3, &rounded, &task, &rest).is_ok());
    let broken = j.map(|value| if value == 1.0 { f64::NAN } else { value });
    assert_eq!(step(0.1, &broken, &v, &z), Err(KinematicsError::SingularTask { damping: 0.1 }));

    // The same control can be used after an error.
    let mut control = ResolvedRate::new(0.0).unwrap();
    let mut velocity = DVector::zeros(5);
    assert!(control.velocity(flat.as_view(), v.as_view(), z.as_view(), velocity.as_view_mut()).is_err());
    control.velocity(j.as_view(), v.as_view(), z.as_view(), velocity.as_view_mut()).unwrap();
}

/// Steps bring the hand of the upper body to a point within reach, where damping costs little.
#[test]
fn a_hand_reaches_a_point() {
    let robot = RobotModel::from_urdf(include_str!("../../../robots/asimo_upper_body.urdf")).unwrap();
    let chain = robot.chain(robot.link("l_palm").unwrap());
    let (mut workspace, mut control) = (Workspace::new(), ResolvedRate::new(0.02).unwrap());
    let mut q = DVector::zeros(22);
    q[robot.joint("l_elbow").unwrap()] = -1.6;
    let start = q.clone();
    let (mut jacobian, mut velocity) = (Matrix3xX::zeros(22), DVector::zeros(22));
    let goal = nalgebra::Point3::new(0.35, 0.1, 0.8);
    let mut error = f64::INFINITY;
    for _ in 0..60 {
        let palm = chain.position_jacobian(q.as_view(), &mut workspace, &mut jacobian).unwrap();
        let task = (goal - palm) * 0.3;
        error = (goal - palm).norm();
        let pull = (&start - &q) * 0.05;
        let task = DVector::from_column_slice(task.as_slice());
        control.velocity(&jacobian, task.as_view(), pull.as_view(), velocity.as_view_mut()).unwrap();
        q += &velocity;
    }
    assert!(error < 1e-4, "{error}");
}
