//! Reference cases of real robots, computed by another library. The files are not part of this project;
//! `CONFORMANCE_VECTORS` names the folder with them (`kinematics/*.json` next to the URDFs).

use std::{
    fs,
    path::{Path, PathBuf},
};

use kinematics::{RobotModel, Workspace};
use nalgebra::{DMatrix, DVector, Matrix3xX, Matrix6xX};
use serde_json::Value;

const TOLERANCE: f64 = 1e-10;

#[test]
#[ignore = "needs reference files: set CONFORMANCE_VECTORS to their folder"]
fn real_robots_agree_with_the_reference() {
    let folder = std::env::var_os("CONFORMANCE_VECTORS").expect("CONFORMANCE_VECTORS names the folder of the files");
    let cases = json_files(&Path::new(&folder).join("kinematics"));
    assert!(!cases.is_empty(), "no reference files in {}", Path::new(&folder).display());
    for case in cases {
        let reference: Value = serde_json::from_str(&fs::read_to_string(&case).unwrap()).unwrap();
        let urdf = fs::read_to_string(case.with_file_name(reference["urdf"].as_str().unwrap())).unwrap();
        let robot = RobotModel::from_urdf(&urdf).unwrap();
        same_joints(&robot, &reference);
        let worst = reference["configurations"].as_array().unwrap().iter().map(|at| difference(&robot, at));
        let worst = worst.fold(difference_of_all_at_once(&robot, &reference), f64::max);
        println!("{}: {worst:.1e}", case.display());
        assert!(worst <= TOLERANCE, "{}: {worst:e}", case.display());
    }
}

#[test]
#[ignore = "needs reference files: set CONFORMANCE_VECTORS to their folder"]
fn odd_files_load_or_are_refused() {
    let folder = std::env::var_os("CONFORMANCE_VECTORS").expect("CONFORMANCE_VECTORS names the folder of the files");
    let folder = Path::new(&folder).join("urdf_traps");
    let expected: Value = serde_json::from_str(&fs::read_to_string(folder.join("expected.json")).unwrap()).unwrap();
    for (file, expected) in expected.as_object().unwrap() {
        let found = RobotModel::from_urdf(&fs::read_to_string(folder.join(file)).unwrap());
        println!("{file}: {}", found.as_ref().map_or_else(ToString::to_string, |_| "loads".to_owned()));
        assert_eq!(found.is_ok(), expected["loads"].as_bool().unwrap(), "{file}: {expected}");
        if let Ok(robot) = found {
            let warns = expected["note"].as_str().unwrap().contains("warning");
            assert_eq!(!robot.warnings().is_empty(), warns, "{file}: {expected}");
        }
    }
}

fn json_files(folder: &Path) -> Vec<PathBuf> {
    let files = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    files.filter(|file| file.extension().is_some_and(|extension| extension == "json")).collect()
}

fn same_joints(robot: &RobotModel, reference: &Value) {
    let names: Vec<&str> = reference["joints"].as_array().unwrap().iter().map(|name| name.as_str().unwrap()).collect();
    assert_eq!(robot.joints().iter().map(kinematics::Joint::name).collect::<Vec<_>>(), names);
    assert_eq!(robot.link_name(robot.root()), reference["root_link"].as_str().unwrap());
    for (joint, limits) in robot.joints().iter().zip(reference["limits"].as_array().unwrap()) {
        assert!(joint.lower() <= joint.upper());
        if let (Some(lower), Some(upper)) = (limits[0].as_f64(), limits[1].as_f64()) {
            assert!((joint.lower() - lower).abs() < 1e-11 && (joint.upper() - upper).abs() < 1e-11, "{joint:?}");
        }
    }
}

/// Largest difference in pose and Jacobian over the frames of one configuration, over all ways to compute them.
fn difference(robot: &RobotModel, reference: &Value) -> f64 {
    let q = DVector::from_vec(numbers(&reference["q"]));
    let mut workspace = Workspace::new();
    let mut six = Matrix6xX::zeros(robot.n_joints());
    let mut three = Matrix3xX::zeros(robot.n_joints());
    let mut worst: f64 = 0.0;
    for (frame, expected) in reference["frames"].as_object().unwrap() {
        let link = robot.link(frame).unwrap();
        let (pose, jacobian) = (matrix(&expected["pose"]), matrix(&expected["jacobian"]));
        let upper = jacobian.rows(0, 3);

        let poses = robot.forward_kinematics(q.as_view(), &mut workspace).unwrap();
        poses.jacobian(link, &mut six).unwrap();
        poses.position_jacobian(link, &mut three).unwrap();
        worst =
            worst.max((DMatrix::from_column_slice(4, 4, poses.pose(link).to_homogeneous().as_slice()) - &pose).amax());
        worst = worst.max((&six - &jacobian).amax()).max((&three - upper).amax());

        let chain = robot.chain(link);
        let reached = chain.jacobian(q.as_view(), &mut workspace, &mut six).unwrap();
        chain.position_jacobian(q.as_view(), &mut workspace, &mut three).unwrap();
        worst = worst.max((DMatrix::from_column_slice(4, 4, reached.to_homogeneous().as_slice()) - &pose).amax());
        worst = worst.max((&six - &jacobian).amax()).max((&three - upper).amax());
    }
    worst
}

/// As [`difference`], with all configurations in one call.
fn difference_of_all_at_once(robot: &RobotModel, reference: &Value) -> f64 {
    let cases = reference["configurations"].as_array().unwrap();
    let columns: Vec<_> = cases.iter().map(|case| DVector::from_vec(numbers(&case["q"]))).collect();
    let (q, n, mut workspace) = (DMatrix::from_columns(&columns), robot.n_joints(), Workspace::new());
    let mut jacobians = Matrix6xX::zeros(n * cases.len());
    let mut worst: f64 = 0.0;
    for frame in cases[0]["frames"].as_object().unwrap().keys() {
        let link = robot.link(frame).unwrap();
        let poses = robot.chain(link).jacobians(q.as_view(), &mut workspace, &mut jacobians).unwrap();
        for (index, case) in cases.iter().enumerate() {
            let expected = &case["frames"][frame];
            let pose = DMatrix::from_column_slice(4, 4, poses[index].to_homogeneous().as_slice());
            worst = worst.max((pose - matrix(&expected["pose"])).amax());
            worst = worst.max((jacobians.columns(index * n, n) - matrix(&expected["jacobian"])).amax());
        }
    }
    worst
}

fn numbers(row: &Value) -> Vec<f64> {
    row.as_array().unwrap().iter().map(|value| value.as_f64().unwrap()).collect()
}

fn matrix(rows: &Value) -> DMatrix<f64> {
    let rows: Vec<Vec<f64>> = rows.as_array().unwrap().iter().map(numbers).collect();
    DMatrix::from_fn(rows.len(), rows[0].len(), |i, j| rows[i][j])
}
