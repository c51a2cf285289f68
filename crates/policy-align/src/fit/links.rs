//! A robot's last links as spaces in which constraints may be constant: (S40).

use gp::{AutoFit, Rows};
use kinematics::RobotModel;
use motion::Decision;
use prepare::numbers::squared_error;

use super::decision::decision;
use crate::channel_joints::{scales_of_joints, unscaled};
use crate::named::TaskLinks;
use crate::{FitError, Prepared};

/// What the spaces of a robot's links are called.
pub(super) struct LinkNames(Vec<String>);

impl LinkNames {
    /// Rows with the spaces of the links of the robot given, if any, and their names.
    pub(super) fn with_spaces(
        rows: Rows,
        prepared: &Prepared,
        robot: Option<&RobotModel>,
    ) -> Result<(Rows, Self), FitError> {
        let Some(robot) = robot else { return Ok((rows, LinkNames(Vec::new()))) };
        let refused = |reason: String| FitError::Robot { reason };
        let channels: Vec<String> = prepared.state.iter().map(|channel| channel.name.clone()).collect();
        let links = TaskLinks::moved_by(robot, &channels).map_err(refused)?;
        let scales = scales_of_joints(&prepared.state);
        let states = unscaled(&rows.states().rows(0, channels.len()).into_owned(), &scales);
        let (names, spaces): (Vec<_>, Vec<_>) = links.poses(&states).map_err(refused)?.into_iter().unzip();
        let spaces = spaces.into_iter().map(|space| space.scaled(&scales)).collect();
        Ok((rows.with_task_spaces(spaces)?, LinkNames(names)))
    }

    /// What was learnt from, where that is the constraints of a link.
    pub(super) fn decision(&self, readings: &AutoFit) -> Option<Decision> {
        let report = readings.slope().report();
        let name = self.0.get(report.task_space?)?;
        let why = format!(
            "constraints are constant there: expected error {}, learnt from all that they leave free",
            squared_error(report.expected_nupe)
        );
        Some(decision("task space", name.clone(), why, "--robot"))
    }
}
