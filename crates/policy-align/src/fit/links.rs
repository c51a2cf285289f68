//! A robot's last links as task spaces in which constraints may be constant: (S40).

use gp::{AutoFit, Rows};
use kinematics::RobotModel;
use motion::{Decision, Subject};
use prepare::numbers::squared_error;

use crate::channel_joints::{scales_of_joints, unscaled};
use crate::named::TaskLinks;
use crate::{FitError, Prepared, StateChannel};

/// Names of the task spaces of a robot's links.
pub(super) struct LinkNames(Vec<String>);

impl LinkNames {
    /// Adds to the rows the task spaces of the given robot's links, if any; also returns the spaces' names.
    pub(super) fn with_spaces(
        rows: Rows,
        prepared: &Prepared,
        robot: Option<&RobotModel>,
    ) -> Result<(Rows, Self), FitError> {
        let Some(robot) = robot else { return Ok((rows, LinkNames(Vec::new()))) };
        let refused = |reason: String| FitError::Robot { reason };
        let channels = StateChannel::names(&prepared.state);
        let links = TaskLinks::moved_by(robot, &channels).map_err(refused)?;
        let scales = scales_of_joints(&prepared.state);
        let states = unscaled(&rows.states().rows(0, channels.len()).into_owned(), &scales);
        let (names, spaces): (Vec<_>, Vec<_>) = links.poses(&states).map_err(refused)?.into_iter().unzip();
        let spaces = spaces.into_iter().map(|space| space.scaled(&scales)).collect();
        Ok((rows.with_task_spaces(spaces)?, LinkNames(names)))
    }

    /// The decision that constraints act on a link, if the fit used that.
    pub(super) fn decision(&self, readings: &AutoFit) -> Option<Decision> {
        let report = readings.slope().report();
        let name = self.0.get(report.task_space?)?;
        let why = format!(
            "constraints are constant there: expected error {}, learnt from all that they leave free",
            squared_error(report.expected_nupe)
        );
        Some(Decision::new(Subject::TaskSpace, name.clone(), why))
    }
}
