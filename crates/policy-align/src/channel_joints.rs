use kinematics::{Joint, JointKind, KinematicsError, RobotModel};
use motion::is_in_degrees;
use nalgebra::{DMatrix, DMatrixView, DVector, DVectorView};
use prepare::StateChannel;

use crate::Finding;

/// Configurations in one batch; their link poses fit into the processor's cache.
const AT_ONCE: usize = 64;

/// Turns above which a joint's numbers are hardly radians.
const TURNS: f64 = 2.0;

/// The joints of a robot that correspond to the channels of a state.
#[derive(Debug, Clone)]
pub(crate) struct ChannelJoints {
    n_joints: usize,
    /// For each channel, the index of its joint in a configuration.
    pub(crate) places: Vec<usize>,
}

impl ChannelJoints {
    /// Finds joints by name, with or without a unit in brackets.
    ///
    /// # Errors
    /// A sentence that names the channel that is not a joint.
    pub(crate) fn of<'a>(robot: &RobotModel, channels: impl Iterator<Item = &'a str>) -> Result<Self, String> {
        let place = |channel: &'a str| {
            joint_of(robot, channel).ok_or_else(|| {
                let joints: Vec<&str> = robot.joints().iter().map(Joint::name).collect();
                format!("channel '{channel}' is not a joint of the robot, which has {}", joints.join(", "))
            })
        };
        Ok(ChannelJoints { n_joints: robot.n_joints(), places: channels.map(place).collect::<Result<_, _>>()? })
    }

    /// One channel for each joint, in the order of a configuration.
    pub(crate) fn in_order(robot: &RobotModel) -> Self {
        ChannelJoints { n_joints: robot.n_joints(), places: (0..robot.n_joints()).collect() }
    }

    /// Number of the robot's joints.
    pub(crate) fn n_joints(&self) -> usize {
        self.n_joints
    }

    /// The configuration of a state (n), in radians and metres; joints without a channel are at 0.
    pub(crate) fn configuration(&self, state: DVectorView<'_, f64>) -> DVector<f64> {
        let mut q = DVector::zeros(self.n_joints);
        for (&place, &x) in self.places.iter().zip(state.iter()) {
            q[place] = x;
        }
        q
    }

    /// [`ChannelJoints::configuration`] of each of these states (n, N); velocities are converted likewise.
    pub(crate) fn configurations(&self, states: DMatrixView<'_, f64>) -> DMatrix<f64> {
        let mut q = DMatrix::zeros(self.n_joints, states.ncols());
        for (&place, row) in self.places.iter().zip(states.row_iter()) {
            q.row_mut(place).copy_from(&row);
        }
        q
    }

    /// Passes the configurations of these states (n, N) to `each` in batches, each with the index of its first state.
    ///
    /// # Errors
    /// Those of `each`; [`KinematicsError::InBatch`] then carries the index among all states.
    pub(crate) fn by_groups(
        &self,
        states: &DMatrix<f64>,
        mut each: impl FnMut(usize, DMatrix<f64>) -> Result<(), KinematicsError>,
    ) -> Result<(), KinematicsError> {
        (0..states.ncols()).step_by(AT_ONCE).try_for_each(|first| {
            let group = states.columns(first, AT_ONCE.min(states.ncols() - first));
            each(first, self.configurations(group)).map_err(|error| match error {
                KinematicsError::InBatch { index, reason } => KinematicsError::InBatch { index: first + index, reason },
                error => error,
            })
        })
    }
}

/// Index in a configuration of the joint that a channel names: `elbow` or `elbow [deg]`.
pub(crate) fn joint_of(robot: &RobotModel, channel: &str) -> Option<usize> {
    let bare = || channel.split(['[', '(']).next().unwrap_or(channel).trim_end();
    robot.joint(channel).or_else(|_| robot.joint(bare())).ok()
}

/// Lists revolute joints among the channels that have no unit and would move by many turns in radians.
pub fn joints_in_degrees(robot: &RobotModel, state: &[StateChannel]) -> Option<Finding> {
    let turns = |channel: &&StateChannel| {
        let kind = joint_of(robot, &channel.name).map(|place| robot.joints()[place].kind());
        channel.unit.is_none() && channel.turns() > TURNS && !matches!(kind, None | Some(JointKind::Prismatic))
    };
    let names: Vec<&str> = state.iter().filter(turns).map(|channel| channel.name.as_str()).collect();
    (!names.is_empty()).then(|| {
        Finding::doubt(
            format!("joints were taken to be in radians, but move by many turns: {}", names.join(", ")),
            format!("if they are in degrees: --degrees {}", names.join(",")),
        )
    })
}

/// Divisors (n) that convert the learner's numbers to radians and metres, for channels that are joints.
pub(crate) fn scales_of_joints(state: &[StateChannel]) -> DVector<f64> {
    let scale = |channel: &StateChannel| channel.scale / unit(channel.unit.as_deref(), None);
    DVector::from_iterator(state.len(), state.iter().map(scale))
}

/// States (n, N) divided by factors (n).
pub(crate) fn unscaled(states: &DMatrix<f64>, scales: &DVector<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(states.nrows(), states.ncols(), |row, column| states[(row, column)] / scales[row])
}

/// Radians or metres per unit of a channel that is a joint; 1 if the unit is unknown. If the kind of the joint is unknown, the unit alone
/// decides.
pub(crate) fn unit(unit: Option<&str>, joint: Option<JointKind>) -> f64 {
    match (unit, joint) {
        (Some("mm"), None | Some(JointKind::Prismatic)) => 1e-3,
        (Some("cm"), None | Some(JointKind::Prismatic)) => 1e-2,
        (_, Some(JointKind::Prismatic)) => 1.0,
        (unit, _) if is_in_degrees(unit) == Some(true) => 1f64.to_radians(),
        _ => 1.0,
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::dvector;

    use super::*;

    #[test]
    fn numbers_become_radians_and_metres() {
        let channel = |(unit, scale): (&str, f64)| StateChannel {
            name: String::new(),
            unit: Some(unit.to_owned()),
            scale,
            low: 0.0,
            high: 1.0,
            median: 0.5,
        };
        let state = [("rad", 1.0), ("deg", 2.0), ("mm", 0.5), ("m", 4.0)].map(channel);
        // The learner's number is the recorded number times the scale.
        let learnt = dvector![1.5, 2.0 * 90.0, 0.5 * 250.0, 4.0 * 0.25];
        let converted = learnt.component_div(&scales_of_joints(&state));
        assert!((converted - dvector![1.5, std::f64::consts::FRAC_PI_2, 0.25, 0.25]).amax() < 1e-12);
    }

    #[test]
    fn joints_that_turn_many_times_are_named() {
        let urdf = r#"<robot name="arm"><link name="base"/><link name="upper"/><link name="slide"/>
            <joint name="elbow" type="continuous"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/></joint>
            <joint name="rail" type="prismatic"><parent link="upper"/><child link="slide"/><axis xyz="1 0 0"/>
                <limit lower="-100" upper="100" effort="1" velocity="1"/></joint></robot>"#;
        let channel = |name: &str, unit: Option<&str>, high: f64| StateChannel {
            name: name.to_owned(),
            unit: unit.map(ToOwned::to_owned),
            scale: 1.0,
            low: -1.0,
            high,
            median: 0.0,
        };
        let robot = RobotModel::from_urdf(urdf).unwrap();
        let found = |state: &[StateChannel]| joints_in_degrees(&robot, state).map(|finding| finding.next);
        let remedy = "if they are in degrees: --degrees elbow";
        assert_eq!(found(&[channel("elbow", None, 80.0), channel("rail", None, 80.0)]).as_deref(), Some(remedy));
        assert_eq!(found(&[channel("elbow", None, 6.5)]), None);
        assert_eq!(found(&[channel("elbow [deg]", Some("deg"), 80.0)]), None);
        assert_eq!(ChannelJoints::of(&robot, ["rail", "elbow [deg]"].into_iter()).unwrap().places, [1, 0]);
        let refused = ChannelJoints::of(&robot, ["q1"].into_iter()).unwrap_err();
        assert_eq!(refused, "channel 'q1' is not a joint of the robot, which has elbow, rail");
    }
}
