//! Poses and Jacobians of real robots.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use anyhow::{Context as _, ensure};
use kinematics::{Joint, RobotModel, Workspace};
use nalgebra::{DMatrix, DVector, Isometry3, Matrix3xX, Matrix6xX};
use serde::Deserialize;

use super::{Agreement, TOLERANCE, read_json};

#[derive(Debug, Deserialize)]
struct Case {
    urdf: String,
    root_link: String,
    joints: Vec<String>,
    configurations: Vec<Configuration>,
}

#[derive(Debug, Deserialize)]
struct Configuration {
    q: Vec<f64>,
    frames: BTreeMap<String, Frame>,
}

/// A pose (4, 4) in the root frame and the Jacobian (6, n) at its origin, in world axes; row by row.
#[derive(Debug, Deserialize)]
struct Frame {
    pose: Vec<Vec<f64>>,
    jacobian: Vec<Vec<f64>>,
}

/// Poses and Jacobians over all configurations and frames, with every way of computing them.
pub(super) fn check(file: &Path) -> anyhow::Result<Vec<Agreement>> {
    let case: Case = read_json(file)?;
    let urdf = file.with_file_name(&case.urdf);
    let text = fs::read_to_string(&urdf).with_context(|| format!("cannot read {}", urdf.display()))?;
    let robot = RobotModel::from_urdf(&text)?;
    let names: Vec<&str> = robot.joints().iter().map(Joint::name).collect();
    ensure!(names == case.joints, "the joints are {names:?}, in the reference {:?}", case.joints);
    let root = robot.link_name(robot.root());
    ensure!(root == case.root_link, "the root link is {root}, in the reference {}", case.root_link);
    let mut agreement = Agreement::new("poses and Jacobians", TOLERANCE);
    for configuration in &case.configurations {
        compare(&robot, configuration, &mut agreement)?;
    }
    Ok(vec![agreement])
}

fn compare(robot: &RobotModel, reference: &Configuration, agreement: &mut Agreement) -> anyhow::Result<()> {
    let q = DVector::from_column_slice(&reference.q);
    let mut workspace = Workspace::new();
    let mut six = Matrix6xX::zeros(robot.n_joints());
    let mut three = Matrix3xX::zeros(robot.n_joints());
    for (name, expected) in &reference.frames {
        let link = robot.link(name)?;
        let (pose, jacobian) = (matrix(&expected.pose), matrix(&expected.jacobian));
        let mut compare = |reached: Isometry3<f64>, six: &Matrix6xX<f64>, three: &Matrix3xX<f64>| {
            let reached = DMatrix::from_column_slice(4, 4, reached.to_homogeneous().as_slice());
            agreement.differ_by((reached - &pose).iter().copied());
            agreement.differ_by((six - &jacobian).iter().copied());
            agreement.differ_by((three - jacobian.rows(0, 3)).iter().copied());
        };
        let poses = robot.forward_kinematics(q.as_view(), &mut workspace)?;
        poses.jacobian(link, &mut six)?;
        poses.position_jacobian(link, &mut three)?;
        compare(nalgebra::convert(poses.pose(link)), &six, &three);
        let chain = robot.chain(link);
        let reached = chain.jacobian(q.as_view(), &mut workspace, &mut six)?;
        chain.position_jacobian(q.as_view(), &mut workspace, &mut three)?;
        compare(nalgebra::convert(reached), &six, &three);
    }
    Ok(())
}

fn matrix(rows: &[Vec<f64>]) -> DMatrix<f64> {
    DMatrix::from_fn(rows.len(), rows.first().map_or(0, Vec::len), |i, j| rows[i][j])
}
