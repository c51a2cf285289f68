//! A robot's mass matrix as the metric in which constraints are at right angles, where movements bear it out.

use gp::{AutoFit, Rows};
use kinematics::{KinematicsError, RobotModel, Workspace};
use motion::Decision;
use nalgebra::{DMatrix, DVector};
use prepare::numbers::squared_error;

use super::decision::decision;
use super::{FitOptions, learn};
use crate::{FitError, Prepared};

/// t of the gain per trajectory from which the metric is better by more than chance.
const LEAST_T: f64 = 2.5;
/// Share of the left-out error that it may leave.
const LEFT: f64 = 0.5;

/// What was learnt in the metric of inertia.
pub(super) struct Weighed {
    pub(super) rows: Rows,
    pub(super) readings: AutoFit,
    pub(super) decision: Decision,
}

/// Learns in the metric of the robot's mass matrix; none if there is no robot, or left-out movements are not predicted better so.
pub(super) fn weighed(
    prepared: &Prepared,
    rows: &Rows,
    plain: &AutoFit,
    options: &FitOptions,
) -> Result<Option<Weighed>, FitError> {
    let Some(text) = &options.robot else { return Ok(None) };
    let refused = |error: KinematicsError| FitError::Robot { reason: error.to_string() };
    let robot = RobotModel::from_urdf(text).map_err(refused)?;
    let joints = prepared.state.iter().map(|channel| robot.joint(&channel.name));
    let joints: Vec<usize> = joints.collect::<Result<_, _>>().map_err(refused)?;
    let scales: Vec<f64> = prepared.state.iter().map(|channel| channel.scale).collect();
    let momenta = momenta(&robot, (&joints, &scales), rows).map_err(refused)?;
    let no_mass = "its links have no masses, or so few that some joints move nothing: give each link <inertial>";
    let rows = rows.clone().with_momenta(momenta).map_err(|_| FitError::Robot { reason: no_mass.to_owned() })?;
    if plain.slope().report().is_nearly_exact() {
        return Ok(None);
    }
    let readings = learn(&rows, options)?;
    let before = plain.slope().report().r_squared;
    let after = readings.slope().report().r_squared;
    let better = plain.gain_t(&readings) >= LEAST_T && 1.0 - after <= LEFT * (1.0 - before);
    let why = format!(
        "constraints are at right angles in this metric: held-out error {}, in that of the channels {}",
        squared_error(1.0 - after),
        squared_error(1.0 - before)
    );
    let decision = decision("metric", format!("mass matrix of {}", robot.name()), why, "--robot");
    Ok(better.then_some(Weighed { rows, readings, decision }))
}

/// M(q)u of every row, (n, M), with other joints than the recorded ones at zero, in the channels' scaled units.
fn momenta(
    robot: &RobotModel,
    (joints, scales): (&[usize], &[f64]),
    rows: &Rows,
) -> Result<DMatrix<f64>, KinematicsError> {
    let mut workspace = Workspace::new();
    let mut q = DVector::zeros(robot.n_joints());
    let mut momenta = rows.velocities().clone();
    for (state, mut momentum) in rows.states().column_iter().zip(momenta.column_iter_mut()) {
        for (place, &joint) in joints.iter().enumerate() {
            q[joint] = state[place] / scales[place];
        }
        let mass = robot.forward_kinematics(q.as_view(), &mut workspace)?.mass_matrix()?;
        let scaled =
            DMatrix::from_fn(joints.len(), joints.len(), |i, j| mass[(joints[i], joints[j])] / (scales[i] * scales[j]));
        let product = scaled * &momentum;
        momentum.copy_from(&product);
    }
    Ok(momenta)
}
