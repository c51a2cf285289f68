use std::fmt;

use constraints::ConstraintError;
use kinematics::KinematicsError;
use motion::MotionError;
use thiserror::Error;

/// The quantity whose dimension must equal that of the potential or policy.
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

/// The quantity of a simulated system that is not finite.
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

/// The reason why no demonstration could be generated. All indices count from 0.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum DemoGenError {
    /// The time step is not a positive, finite number of seconds.
    #[error("time step {time_step} s: it must be a positive, finite number of seconds between two samples")]
    TimeStep {
        /// The time step given, in seconds.
        time_step: f64,
    },
    /// A movement must have at least two samples.
    #[error("{n_samples} sample(s) asked for; a movement has at least 2")]
    TooFewSamples {
        /// The requested number.
        n_samples: usize,
    },
    /// The number of sub-steps must not be 0.
    #[error("0 sub-steps asked for; 1 is the plain Euler step")]
    NoSubStep,
    /// Potential or policy, constraint and start have different dimensions.
    #[error("the {part} has {found} dimensions, the potential or policy {expected}; all must share one state space")]
    Dimensions {
        /// The quantity that differs from the potential or policy.
        part: Part,
        /// Its number of dimensions.
        found: usize,
        /// The number of dimensions of the potential or policy.
        expected: usize,
    },
    /// The movement became infinite or NaN.
    #[error(
        "sample {sample}: the {quantity} is not finite; start inside the potential's domain, \
         or take a smaller time step or more sub-steps"
    )]
    Diverged {
        /// The first sample that is not finite.
        sample: usize,
        /// The quantity that is not finite there.
        quantity: Quantity,
    },
    /// The constraint could not be evaluated.
    #[error("constraint at sample {sample}: {source}")]
    Constraint {
        /// The sample at which, or on the way from which, the constraint was evaluated.
        sample: usize,
        /// The reason.
        source: ConstraintError,
    },
    /// The matrix does not have the shape of a hand's Jacobian.
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
    /// No trajectory was requested, or no recording given.
    #[error("there is no trajectory; ask for or give at least one")]
    NoTrajectory,
    /// Some constraint would not apply to any sample.
    #[error("{redraw:?} with {n_samples} samples: each constraint must hold for at least one")]
    Redraw {
        /// The rule given.
        redraw: crate::Redraw,
        /// Number of samples of a trajectory.
        n_samples: usize,
    },
    /// The requested dimension is too small for this policy.
    #[error("{found} dimension(s) asked for; this policy lives in {least} or more")]
    TooFewDimensions {
        /// The requested dimension.
        found: usize,
        /// The smallest allowed dimension.
        least: usize,
    },
    /// The width of the edge between planes is negative or not finite.
    #[error("edge {edge}: it must be a finite width, 0 (a kink) or more, in units of the state")]
    Edge {
        /// The width given.
        edge: f64,
    },
    /// The noise share is negative or not finite.
    #[error("noise share {share}: it must be a finite number, 0 or more, of each dimension's standard deviation")]
    NoiseShare {
        /// The share given.
        share: f64,
    },
    /// The signal-to-noise ratio is not finite.
    #[error(
        "signal-to-noise ratio {decibels} dB: it must be a finite number; record without noise instead of infinity"
    )]
    SignalToNoise {
        /// The ratio given, in decibels.
        decibels: f64,
    },
    /// The recording lacks the velocities that are required.
    #[error("trajectory {trajectory} has no velocities; noise on velocities needs them")]
    NoVelocities {
        /// Index of the trajectory.
        trajectory: usize,
    },
    /// The range of the task b of a constraint A u = b is invalid.
    #[error("task {largest}: it must be a finite number, 0 or more")]
    Task {
        /// The largest task given.
        largest: f64,
    },
    /// The tilt of a surface is out of range.
    #[error("tilt {largest}: it must be an angle from 0 up to a right angle, in radians")]
    Tilt {
        /// The largest tilt given, in radians.
        largest: f64,
    },
    /// The robot's number of joints differs from that of the posture.
    #[error("the robot has {found} joints, the posture {expected}; take a robot of as many")]
    Joints {
        /// Joints of the robot.
        found: usize,
        /// Joints of the posture.
        expected: usize,
    },
    /// One of several trajectories cannot be generated.
    #[error("trajectory {trajectory}: {source}")]
    InTrajectory {
        /// Index of the trajectory.
        trajectory: usize,
        /// The reason.
        source: Box<DemoGenError>,
    },
    /// The range of start states is negative or not finite.
    #[error("start range {range}: it must be a finite number, 0 or more, in the unit of the state")]
    StartRange {
        /// The range given.
        range: f64,
    },
    /// A standard deviation is negative or not finite.
    #[error("{name} {value}: it must be a finite number, 0 or more, in radians")]
    Deviation {
        /// Name of the quantity.
        name: &'static str,
        /// The deviation given.
        value: f64,
    },
    /// A rate is not positive or not finite.
    #[error("task rate {rate}: it must be a finite number above 0, in 1/s")]
    TaskRate {
        /// The rate given.
        rate: f64,
    },
    /// The variance of start states is negative or not finite.
    #[error("start variance {variance}: it must be a finite number, 0 or more, in units of the coordinates squared")]
    StartVariance {
        /// The variance given.
        variance: f64,
    },
    /// No collision-free start state was found.
    #[error(
        "{draws} start states drawn around the posture, all in self-collision; take a freer posture, or an SRDF that \
         disables pairs of links which may overlap"
    )]
    NoFreeStart {
        /// Number of start states drawn.
        draws: usize,
    },
    /// The parameters of the gap's distribution are invalid.
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
    /// No start posture was found with both palms in the start region of a grasp.
    #[error(
        "{draws} start postures drawn, none with both palms before the body and each on its side; \
         widen `start_depth`, lower `start_side`, or move the table"
    )]
    NoNaturalStart {
        /// Number of start postures drawn.
        draws: usize,
    },
    /// The robot does not suit the scenario, or rejects a configuration.
    #[error(transparent)]
    Robot(#[from] KinematicsError),
    /// The recorded data are not a valid set of movements.
    #[error(transparent)]
    Motion(#[from] MotionError),
}
