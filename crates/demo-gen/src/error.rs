use std::fmt;

use constraints::ConstraintError;
use kinematics::KinematicsError;
use motion::MotionError;
use thiserror::Error;

/// What must share the state space of the potential or policy.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// The start state.
    Start,
    /// The constraint.
    Constraint,
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Part::Start => "start state",
            Part::Constraint => "constraint",
        })
    }
}

/// What of a simulated system left the finite numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// The state x.
    State,
    /// The potential φ(x).
    Potential,
    /// The policy π(x).
    Policy,
    /// The velocity N π(x).
    Velocity,
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Quantity::State => "state",
            Quantity::Potential => "potential",
            Quantity::Policy => "policy",
            Quantity::Velocity => "velocity",
        })
    }
}

/// Why no demonstration could be made. All numbers count from 0.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum DemoGenError {
    /// The time step is not a positive, finite number of seconds.
    #[error("time step {time_step} s: it must be a positive, finite number of seconds between two samples")]
    TimeStep {
        /// The time step given, in seconds.
        time_step: f64,
    },
    /// A movement needs two samples.
    #[error("{n_samples} sample(s) asked for; a movement has at least 2")]
    TooFewSamples {
        /// The number asked for.
        n_samples: usize,
    },
    /// A step cannot be made of no step.
    #[error("0 sub-steps asked for; 1 is the plain Euler step")]
    NoSubStep,
    /// Potential or policy, constraint and start do not live in one space.
    #[error("the {part} has {found} dimensions, the potential or policy {expected}; all must share one state space")]
    Dimensions {
        /// What differs from the potential or policy.
        part: Part,
        /// Its number of dimensions.
        found: usize,
        /// The number of dimensions of the potential or policy.
        expected: usize,
    },
    /// The movement left the finite numbers.
    #[error(
        "sample {sample}: the {quantity} is not finite; start inside the potential's domain, \
         or take a smaller time step or more sub-steps"
    )]
    Diverged {
        /// The first sample at fault.
        sample: usize,
        /// What is not finite there.
        quantity: Quantity,
    },
    /// The constraint could not be evaluated.
    #[error("constraint at sample {sample}: {source}")]
    Constraint {
        /// The sample at which, or on the way from which, it was evaluated.
        sample: usize,
        /// What is wrong with it.
        source: ConstraintError,
    },
    /// A matrix cannot hold the Jacobian of a hand.
    #[error(
        "the Jacobian of this hand is ({}, {}), not ({}, {}); normals have 3 coordinates, states one for each joint",
        expected.0, expected.1, found.0, found.1
    )]
    HandJacobian {
        /// Rows and columns of the matrix to be filled.
        found: (usize, usize),
        /// Rows and columns of the Jacobian.
        expected: (usize, usize),
    },
    /// No trajectory was asked for, or no recording given.
    #[error("there is no trajectory; ask for or give at least one")]
    NoTrajectory,
    /// Some constraint would hold for no sample.
    #[error("{redraw:?} with {n_samples} samples: each constraint must hold for at least one")]
    Redraw {
        /// The rule given.
        redraw: crate::Redraw,
        /// Samples of a trajectory.
        n_samples: usize,
    },
    /// A policy needs more dimensions than asked for.
    #[error("{found} dimension(s) asked for; this policy lives in {least} or more")]
    TooFewDimensions {
        /// The number asked for.
        found: usize,
        /// The least number.
        least: usize,
    },
    /// The edge between planes has no width.
    #[error("edge {edge}: it must be a finite width, 0 (a kink) or more, in units of the state")]
    Edge {
        /// The width given.
        edge: f64,
    },
    /// The noise is not a share.
    #[error("noise share {share}: it must be a finite number, 0 or more, of each dimension's standard deviation")]
    NoiseShare {
        /// The share given.
        share: f64,
    },
    /// The ratio of signal to noise is no number of decibels.
    #[error(
        "signal-to-noise ratio {decibels} dB: it must be a finite number; record without noise instead of infinity"
    )]
    SignalToNoise {
        /// The ratio given, in decibels.
        decibels: f64,
    },
    /// Velocities are needed that were not recorded.
    #[error("trajectory {trajectory} has no velocities; noise on velocities needs them")]
    NoVelocities {
        /// Which trajectory.
        trajectory: usize,
    },
    /// The task of a constraint A u = b cannot be drawn.
    #[error("task {largest}: it must be a finite number, 0 or more")]
    Task {
        /// The largest task given.
        largest: f64,
    },
    /// A surface cannot be tilted so far.
    #[error("tilt {largest}: it must be an angle from 0 up to a right angle, in radians")]
    Tilt {
        /// The largest tilt given, in radians.
        largest: f64,
    },
    /// A robot has not the joints that a posture is for.
    #[error("the robot has {found} joints, the posture {expected}; take a robot of as many")]
    Joints {
        /// Joints of the robot.
        found: usize,
        /// Joints of the posture.
        expected: usize,
    },
    /// One of several trajectories cannot be made.
    #[error("trajectory {trajectory}: {source}")]
    InTrajectory {
        /// Which trajectory.
        trajectory: usize,
        /// What is wrong with it.
        source: Box<DemoGenError>,
    },
    /// The range of start states is not a number from 0 up.
    #[error("start range {range}: it must be a finite number, 0 or more, in the unit of the state")]
    StartRange {
        /// The range given.
        range: f64,
    },
    /// A standard deviation is not a number from 0 up.
    #[error("{name} {value}: it must be a finite number, 0 or more, in radians")]
    Deviation {
        /// Of what.
        name: &'static str,
        /// The deviation given.
        value: f64,
    },
    /// A rate is not a number above 0.
    #[error("task rate {rate}: it must be a finite number above 0, in 1/s")]
    TaskRate {
        /// The rate given.
        rate: f64,
    },
    /// The variance of start states is not a number from 0 up.
    #[error("start variance {variance}: it must be a finite number, 0 or more, in units of the coordinates squared")]
    StartVariance {
        /// The variance given.
        variance: f64,
    },
    /// No start state was found that is free of collisions.
    #[error(
        "{draws} start states drawn around the posture, all in self-collision; take a freer posture, or an SRDF that \
         disables pairs of links which may overlap"
    )]
    NoFreeStart {
        /// How many were drawn.
        draws: usize,
    },
    /// The gap of a wall cannot be drawn.
    #[error(
        "gap {mean} m with standard deviation {deviation} m, at least {least} m: all must be finite, \
         the last two 0 or more"
    )]
    Gap {
        /// The mean given, in metres.
        mean: f64,
        /// The standard deviation given, in metres.
        deviation: f64,
        /// The least gap given, in metres.
        least: f64,
    },
    /// No start posture was found with both palms where a grasp begins.
    #[error(
        "{draws} start postures drawn, none with both palms before the body and each on its side; \
         widen `start_depth`, lower `start_side`, or move the table"
    )]
    NoNaturalStart {
        /// How many were drawn.
        draws: usize,
    },
    /// The robot is not what the scenario needs, or refuses a configuration.
    #[error(transparent)]
    Robot(#[from] KinematicsError),
    /// What was recorded is not a valid set of movements.
    #[error(transparent)]
    Motion(#[from] MotionError),
}
