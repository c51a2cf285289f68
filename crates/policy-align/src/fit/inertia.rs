//! A robot's mass matrix as the metric in which constraints project orthogonally, if the movements support it.

use gp::{AutoFit, Rows};
use kinematics::{KinematicsError, RobotModel, Workspace};
use motion::{Decision, Subject};
use nalgebra::{DMatrix, DVector};
use prepare::numbers::squared_error;

use super::{FitOptions, learn};
use crate::channel_joints::{ChannelJoints, scales_of_joints, unscaled};
use crate::{FitError, Prepared};

/// The result of learning in the metric of inertia.
pub(super) struct Weighed {
    pub(super) rows: Rows,
    pub(super) readings: AutoFit,
    pub(super) decision: Decision,
}

/// Learns in the metric of the robot's mass matrix; `None` without a robot, or if left-out movements are not predicted better.
pub(super) fn weighed(
    prepared: &Prepared,
    rows: &Rows,
    plain: &AutoFit,
    (robot, options): (Option<&RobotModel>, &FitOptions),
) -> Result<Option<Weighed>, FitError> {
    let Some(robot) = robot else { return Ok(None) };
    let refused = |error: KinematicsError| FitError::Robot { reason: error.to_string() };
    let joints = ChannelJoints::of(robot, prepared.state.iter().map(|channel| channel.name.as_str()));
    let joints = joints.map_err(|reason| FitError::Robot { reason })?;
    let scales = scales_of_joints(&prepared.state);
    let momenta = momenta(robot, &joints, &scales, rows).map_err(refused)?;
    let Ok(rows) = rows.clone().with_momenta(momenta) else {
        let no_mass = "its mass matrix is singular: some joints move links without masses only, and no link at the end of a chain is moved by the channels alone; give each link <inertial>";
        let of_use = !rows.task_spaces().is_empty();
        return if of_use { Ok(None) } else { Err(FitError::Robot { reason: no_mass.to_owned() }) };
    };
    if plain.slope().report().is_nearly_exact() {
        return Ok(None);
    }
    let readings = learn(&rows, options)?;
    if !plain.is_much_worse_than(&readings) {
        return Ok(None);
    }
    let [before, after] = [plain, &readings].map(|of| squared_error(1.0 - of.slope().report().r_squared));
    let why = format!(
        "constraints are at right angles in this metric: error relative to the motion {after}, in that of the channels {before}"
    );
    let decision = Decision::new(Subject::Metric, format!("mass matrix of {}", robot.name()), why);
    Ok(Some(Weighed { rows, readings, decision }))
}

/// M(q)u of every row, (n, M), in the channels' scaled units: S⁻¹M(q)S⁻¹u with the scales S. Joints that were not recorded are at
/// zero.
fn momenta(
    robot: &RobotModel,
    joints: &ChannelJoints,
    scales: &DVector<f64>,
    rows: &Rows,
) -> Result<DMatrix<f64>, KinematicsError> {
    let mut workspace = Workspace::new();
    let n = scales.len();
    let mut momenta = DMatrix::zeros(n, rows.len());
    joints.by_groups(&unscaled(&rows.states().rows(0, n).into_owned(), scales), |first, q| {
        let velocities = unscaled(&rows.velocities().columns(first, q.ncols()).into_owned(), scales);
        let poses = robot.forward_kinematics_batch(q.as_view(), &mut workspace)?;
        let of_joints = poses.momenta(joints.configurations(velocities.as_view()).as_view())?;
        for (channel, &place) in joints.places.iter().enumerate() {
            let scaled = of_joints.row(place) / scales[channel];
            momenta.row_mut(channel).columns_mut(first, q.ncols()).copy_from(&scaled);
        }
        Ok(())
    })?;
    Ok(momenta)
}
