use std::time::Duration;

use motion::{LearntPolicy as _, Policy as _};
use nalgebra::{DMatrix, DVector};

use super::joint_order::{CommandedJoint, commanded};
use super::{ControllerError, Halt, Quantity};
use crate::{Model, ModelPolicy};

/// Commands velocities of a robot's joints according to a model's policy, and zero whenever the policy must not be used.
///
/// It reads no clock: all times are durations since one instant, which the caller chooses, on a monotonic clock. Positions may arrive
/// in one or several messages, together with joints that are not channels; the newest position of each joint counts.
///
/// Positions are in radians or metres and velocities in radians or metres per second, as in ROS 2. Channels in degrees, centimetres or
/// millimetres are converted.
#[derive(Debug)]
pub struct VelocityController<'a> {
    policy: ModelPolicy<'a>,
    joints: Vec<CommandedJoint>,
    stale: Duration,
    max_speed: Option<f64>,
    /// Newest position of each joint with its time of arrival, in the order of the command.
    positions: Vec<Option<(f64, Duration)>>,
    /// The joints of the newest message.
    found: Option<Vec<String>>,
}

/// A command to a robot.
#[derive(Debug, Clone, PartialEq)]
pub struct VelocityCommand {
    /// Velocity of each joint in the order of [`VelocityController::joints`], (n), in rad/s or m/s.
    pub velocities: DVector<f64>,
    /// The reason why they are zero, if the robot must stop.
    pub halt: Option<Halt>,
    /// Seconds since the oldest position arrived; `None` while one is missing.
    pub age: Option<f64>,
    /// [`LearntPolicy::support`](motion::LearntPolicy::support) of the state; `None` if not evaluated.
    pub support: Option<f64>,
}

impl<'a> VelocityController<'a> {
    /// A controller for a model in its fixed context. `joints` are pairs of a channel and its joint, in the order of the command;
    /// without pairs each channel is the joint of its name, in the order of the model. Positions older than `stale` seconds stop the
    /// robot.
    ///
    /// # Errors
    /// [`ControllerError`]: a context is open, `stale` is not positive, or the pairs do not name each channel once.
    pub fn new(model: &'a Model, joints: &[(String, String)], stale: f64) -> Result<Self, ControllerError> {
        if !model.open_context().is_empty() {
            return Err(ControllerError::Context { names: model.context_names() });
        }
        let stale = Duration::try_from_secs_f64(positive("stale", stale)?).unwrap_or(Duration::MAX);
        let joints = commanded(model, joints)?;
        let positions = vec![None; joints.len()];
        Ok(VelocityController { policy: model.policy(), joints, stale, max_speed: None, positions, found: None })
    }

    /// The controller with every joint limited to `max_speed`, in rad/s or m/s. All joints are slowed by one factor, so that the
    /// direction stays the same.
    ///
    /// # Errors
    /// [`ControllerError::NotPositive`].
    pub fn with_max_speed(self, max_speed: f64) -> Result<Self, ControllerError> {
        Ok(VelocityController { max_speed: Some(positive("max-speed", max_speed)?), ..self })
    }

    /// The joints in the order of the command, (n).
    pub fn joints(&self) -> Vec<String> {
        self.joints.iter().map(|joint| joint.name.clone()).collect()
    }

    /// Takes a message that arrived at `now`: the position of each named joint. A name without a position is ignored.
    pub fn observe(&mut self, names: &[String], positions: &[f64], now: Duration) {
        for (joint, newest) in self.joints.iter().zip(&mut self.positions) {
            let at = names.iter().position(|name| *name == joint.name);
            if let Some(&position) = at.and_then(|at| positions.get(at)) {
                *newest = Some((position, now));
            }
        }
        self.found = Some(names.iter().zip(positions).map(|(name, _)| name.clone()).collect());
    }

    /// The command at `now`: π(x) at the newest positions, or zero with the reason.
    pub fn command(&self, now: Duration) -> VelocityCommand {
        let age = self.oldest().map(|(_, came)| now.saturating_sub(came).as_secs_f64());
        let mut command =
            VelocityCommand { velocities: DVector::zeros(self.joints.len()), halt: None, age, support: None };
        match self.state(now) {
            Ok(state) => {
                let support = self.policy.certainty(state.as_view()).support[0];
                command.support = Some(support);
                match self.velocities(&state, support) {
                    Ok(velocities) => command.velocities = velocities,
                    Err(halt) => command.halt = Some(halt),
                }
            }
            Err(halt) => command.halt = Some(halt),
        }
        command
    }

    /// The joint whose position is oldest, with its time of arrival; `None` while a position is missing.
    fn oldest(&self) -> Option<(&str, Duration)> {
        let came = self.positions.iter().map(|newest| newest.map(|(_, came)| came)).collect::<Option<Vec<_>>>()?;
        self.joints.iter().map(|joint| joint.name.as_str()).zip(came).min_by_key(|(_, came)| *came)
    }

    /// The state (n, 1) in units of the recording.
    fn state(&self, now: Duration) -> Result<DMatrix<f64>, Halt> {
        let Some(found) = &self.found else { return Err(Halt::NoState) };
        let Some((joint, came)) = self.oldest() else {
            let missing = self.joints.iter().zip(&self.positions).filter(|(_, newest)| newest.is_none());
            let joints = missing.map(|(joint, _)| joint.name.clone()).collect();
            return Err(Halt::Missing { joints, found: found.clone() });
        };
        let age = now.saturating_sub(came);
        if age > self.stale {
            return Err(Halt::Stale { joint: joint.to_owned(), age: age.as_secs_f64() });
        }
        let mut state = DMatrix::zeros(self.joints.len(), 1);
        for (joint, (position, _)) in self.joints.iter().zip(self.positions.iter().flatten()) {
            state[joint.channel] = finite(Quantity::Position, joint, *position)? / joint.unit;
        }
        Ok(state)
    }

    /// The velocities (n) at a state (n, 1), equal to those of `predict`.
    fn velocities(&self, state: &DMatrix<f64>, support: f64) -> Result<DVector<f64>, Halt> {
        if support.is_nan() || support < self.policy.least_support() {
            return Err(Halt::Outside { support });
        }
        let action = self.policy.actions(state.as_view());
        let mut velocities = DVector::zeros(self.joints.len());
        for (joint, velocity) in self.joints.iter().zip(velocities.iter_mut()) {
            *velocity = finite(Quantity::Velocity, joint, action[joint.channel] * joint.unit)?;
        }
        if let Some(max_speed) = self.max_speed {
            let fastest = velocities.amax();
            if fastest > max_speed {
                velocities *= max_speed / fastest;
            }
        }
        Ok(velocities)
    }
}

fn finite(quantity: Quantity, joint: &CommandedJoint, value: f64) -> Result<f64, Halt> {
    let halt = || Halt::NotFinite { quantity, joint: joint.name.clone(), value };
    value.is_finite().then_some(value).ok_or_else(halt)
}

fn positive(name: &'static str, value: f64) -> Result<f64, ControllerError> {
    let is_positive = value > 0.0 && value.is_finite();
    is_positive.then_some(value).ok_or(ControllerError::NotPositive { name, value })
}
