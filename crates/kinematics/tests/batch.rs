//! Several configurations at once give the same bits as single ones.
use crate::random_tree::{RandomTree, tree};
use kinematics::{KinematicsError, RobotModel, Workspace};
use nalgebra::{DMatrix, IsometryMatrix3, Matrix6xX};
use proptest::prelude::*;

/// A tree and configurations in columns: none, fewer or more than there are lanes, or multiples of them.
fn configurations() -> impl Strategy<Value = (RandomTree, DMatrix<f64>)> {
    let value = prop_oneof![6 => -4.0..4.0_f64, 1 => Just(0.0), 1 => Just(-0.0), 1 => -1e7..1e7_f64];
    (tree(), 0..=17_usize).prop_flat_map(move |(tree, count)| {
        let n = tree.active().len();
        let values = proptest::collection::vec(value.clone(), n * count);
        (Just(tree), values.prop_map(move |values| DMatrix::from_vec(n, count, values)))
    })
}

fn bits<'a>(numbers: impl IntoIterator<Item = &'a f64>) -> Vec<u64> {
    numbers.into_iter().map(|number| number.to_bits()).collect()
}

fn pose_bits(pose: &IsometryMatrix3<f64>) -> Vec<u64> {
    bits(pose.rotation.matrix().iter().chain(&pose.translation.vector))
}

proptest! {
    #[test]
    fn all_links((tree, q) in configurations()) {
        let robot = RobotModel::from_urdf(&tree.urdf()).unwrap();
        let (n, mut one, mut several) = (robot.n_joints(), Workspace::new(), Workspace::new());
        let (mut single, mut together) = (Matrix6xX::zeros(n), Matrix6xX::repeat(n * q.ncols(), f64::NAN));
        let batch = robot.forward_kinematics_batch(q.as_view(), &mut several).unwrap();
        prop_assert_eq!((batch.len(), batch.is_empty()), (q.ncols(), q.ncols() == 0));
        for link in robot.links() {
            batch.jacobians(link, &mut together).unwrap();
            for (index, q) in q.column_iter().enumerate() {
                let poses = robot.forward_kinematics(q.as_view(), &mut one).unwrap();
                poses.jacobian(link, &mut single).unwrap();
                prop_assert_eq!(bits(together.columns(index * n, n)), bits(&single));
                prop_assert_eq!(pose_bits(&batch.pose(link, index)), pose_bits(&poses.pose(link)));
                prop_assert_eq!(batch.position(link, index), poses.position(link));
            }
        }
    }

    #[test]
    fn momenta_are_the_product_with_the_mass_matrix((tree, q) in configurations()) {
        let robot = RobotModel::from_urdf(&tree.urdf()).unwrap();
        let (mut one, mut several) = (Workspace::new(), Workspace::new());
        let velocities = DMatrix::from_fn(q.nrows(), q.ncols(), |joint, index| ((3 * joint + 7 * index) as f64).sin());
        let momenta = robot.forward_kinematics_batch(q.as_view(), &mut several).unwrap().momenta(velocities.as_view()).unwrap();
        prop_assert_eq!(momenta.shape(), q.shape());
        for (index, q) in q.column_iter().enumerate() {
            let mass = robot.forward_kinematics(q.as_view(), &mut one).unwrap().mass_matrix().unwrap();
            let expected = &mass * velocities.column(index);
            // Prismatic joints in this range move links as far as 1e7 m away.
            prop_assert!((momenta.column(index) - expected).amax() <= 1e-12 * mass.amax());
        }
    }

    #[test]
    fn chains((tree, q) in configurations()) {
        let robot = RobotModel::from_urdf(&tree.urdf()).unwrap();
        // One workspace for both, and for chains of different lengths.
        let (n, mut workspace) = (robot.n_joints(), Workspace::new());
        let (mut single, mut together) = (Matrix6xX::zeros(n), Matrix6xX::repeat(n * q.ncols(), f64::NAN));
        for link in robot.links() {
            let chain = robot.chain(link);
            let poses = chain.poses(q.as_view(), &mut workspace).unwrap().to_vec();
            let reached = chain.jacobians(q.as_view(), &mut workspace, &mut together).unwrap();
            prop_assert_eq!(reached, &poses[..]);
            prop_assert_eq!(poses.len(), q.ncols());
            for (index, q) in q.column_iter().enumerate() {
                let pose = chain.jacobian(q.as_view(), &mut workspace, &mut single).unwrap();
                prop_assert_eq!(bits(together.columns(index * n, n)), bits(&single));
                prop_assert_eq!(pose_bits(&poses[index]), pose_bits(&pose));
            }
        }
    }
}

const DOOR: &str = r#"<robot name="door"><link name="frame"/><link name="leaf"/>
    <joint name="hinge" type="continuous"><parent link="frame"/><child link="leaf"/><axis xyz="0 0 1"/></joint></robot>"#;

#[test]
fn errors_name_the_configuration() {
    let robot = RobotModel::from_urdf(DOOR).unwrap();
    let (chain, mut workspace) = (robot.chain(robot.link("leaf").unwrap()), Workspace::new());
    let mut refused = |q: &DMatrix<f64>| {
        let all = robot.forward_kinematics_batch(q.as_view(), &mut workspace).unwrap_err().to_string();
        assert_eq!(chain.poses(q.as_view(), &mut workspace).unwrap_err().to_string(), all);
        let mut jacobians = Matrix6xX::zeros(q.ncols());
        let filled = chain.jacobians(q.as_view(), &mut workspace, &mut jacobians);
        assert_eq!(filled.unwrap_err().to_string(), all);
        all
    };
    let mut q = DMatrix::zeros(1, 11);
    q[9] = f64::NAN;
    q[10] = f64::INFINITY;
    assert_eq!(refused(&q), "configuration 9: joint \"hinge\" (value 0): NaN is not a finite number");
    q[3] = 1e101;
    assert_eq!(refused(&q), "configuration 3: joint \"hinge\" (value 0): 1e101 is too far, 1e100 is the most");
    let two = DMatrix::zeros(2, 3);
    assert_eq!(
        refused(&two),
        "configuration 0: the configuration has 2 values, the robot has 1 active joints; give one value each"
    );
}

#[test]
fn jacobians_have_a_column_for_each_joint_in_each_configuration() {
    let robot = RobotModel::from_urdf(DOOR).unwrap();
    let leaf = robot.link("leaf").unwrap();
    let (mut workspace, q) = (Workspace::new(), DMatrix::zeros(1, 9));
    let mut jacobians = Matrix6xX::zeros(8);
    let expected = KinematicsError::BatchColumns { found: 8, configurations: 9, joints: 1 };
    assert_eq!(robot.chain(leaf).jacobians(q.as_view(), &mut workspace, &mut jacobians).unwrap_err(), expected);
    let batch = robot.forward_kinematics_batch(q.as_view(), &mut workspace).unwrap();
    assert_eq!(batch.jacobians(leaf, &mut jacobians).unwrap_err(), expected);
    assert_eq!(
        expected.to_string(),
        "the Jacobians have 8 columns together; give 9 (9 configurations of 1 active joints)"
    );
}

#[test]
fn velocities_have_a_value_for_each_joint_in_each_configuration() {
    let robot = RobotModel::from_urdf(DOOR).unwrap();
    let (mut workspace, q) = (Workspace::new(), DMatrix::zeros(1, 9));
    let batch = robot.forward_kinematics_batch(q.as_view(), &mut workspace).unwrap();
    let error = batch.momenta(DMatrix::zeros(1, 8).as_view()).unwrap_err();
    assert_eq!(error, KinematicsError::VelocitiesShape { found: (1, 8), expected: (1, 9) });
    let sentence = "the velocities have the shape (1, 8); give (1, 9), active joints by configurations";
    assert_eq!(error.to_string(), sentence);
    assert_eq!(batch.momenta(DMatrix::repeat(1, 9, 2.0).as_view()).unwrap(), DMatrix::zeros(1, 9));
}

#[test]
#[should_panic(expected = "configuration 9 of 9")]
fn there_is_no_pose_beyond_the_last_configuration() {
    let robot = RobotModel::from_urdf(DOOR).unwrap();
    let mut workspace = Workspace::new();
    let q = DMatrix::zeros(1, 9);
    robot.forward_kinematics_batch(q.as_view(), &mut workspace).unwrap().pose(robot.root(), 9);
}

/// Columns of a larger matrix need not be contiguous.
#[test]
fn a_view_of_some_rows() {
    let robot = RobotModel::from_urdf(DOOR).unwrap();
    let chain = robot.chain(robot.link("leaf").unwrap());
    let larger = DMatrix::from_fn(3, 12, |row, column| (row * 12 + column) as f64);
    let (mut several, mut one) = (Workspace::new(), Workspace::new());
    let poses = chain.poses(larger.rows(1, 1), &mut several).unwrap();
    for (pose, q) in poses.iter().zip(larger.rows(1, 1).column_iter()) {
        assert_eq!(*pose, chain.pose(q.as_view(), &mut one).unwrap());
    }
}
