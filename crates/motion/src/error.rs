use thiserror::Error;

/// The series of a trajectory to which a value belongs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Series {
    /// The states x.
    States,
    /// The recorded velocities or commands u.
    Velocities,
}

impl std::fmt::Display for Series {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Series::States => "states",
            Series::Velocities => "velocities",
        })
    }
}

/// Reasons why observed movements cannot be used. All numbers count from 0.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum MotionError {
    /// A value is NaN or infinite.
    #[error(
        "{series}, sample {sample}, dimension {dimension}: {value} is not a finite number; drop or interpolate the sample"
    )]
    NotFinite {
        /// The series.
        series: Series,
        /// Column of the value.
        sample: usize,
        /// Row of the value.
        dimension: usize,
        /// The value itself.
        value: f64,
    },
    /// A number of the context is NaN or infinite.
    #[error("context, number {number}: {value} is not a finite number; give one, or leave the movement out")]
    ContextNotFinite {
        /// Index in the context.
        number: usize,
        /// The value itself.
        value: f64,
    },
    /// A trajectory has fewer than two samples.
    #[error("the trajectory has {samples} sample(s), at least 2 are needed to see a movement; leave it out")]
    TooShort {
        /// Number of samples.
        samples: usize,
    },
    /// The state has no dimension.
    #[error("the states have no dimension (0 rows); samples are columns, one row a dimension")]
    NoDimension,
    /// The time step is not a positive, finite number of seconds.
    #[error("time step {time_step} s: it must be a positive, finite number of seconds between two samples")]
    TimeStep {
        /// The time step given, in seconds.
        time_step: f64,
    },
    /// The number of time stamps differs from the number of samples.
    #[error("there are {times} time stamps for {samples} samples; give one per sample")]
    StampCount {
        /// Number of time stamps.
        times: usize,
        /// Number of samples.
        samples: usize,
    },
    /// Time stamps do not ascend, or are not finite.
    #[error(
        "time stamp {time} s of sample {sample} does not come after the one before; sort the samples, drop duplicates"
    )]
    StampOrder {
        /// The first sample out of order.
        sample: usize,
        /// Its time stamp in seconds.
        time: f64,
    },
    /// Velocities do not have the states' shape.
    #[error(
        "velocities have shape ({}, {}), states ({}, {}): record one velocity per state",
        velocities.0, velocities.1, states.0, states.1
    )]
    VelocityShape {
        /// Rows and columns of the states.
        states: (usize, usize),
        /// Rows and columns of the velocities.
        velocities: (usize, usize),
    },
    /// No trajectory was given.
    #[error("there is no trajectory; give at least one")]
    Empty,
    /// Two trajectories differ in dimension.
    #[error(
        "trajectory {trajectory} has {found} dimensions, trajectory 0 has {expected}; all must share one state space"
    )]
    Dimensions {
        /// The first trajectory that differs.
        trajectory: usize,
        /// Its number of dimensions.
        found: usize,
        /// The number of dimensions of trajectory 0.
        expected: usize,
    },
    /// Two trajectories differ in the dimension of their context.
    #[error(
        "the context of trajectory {trajectory} has {found} numbers, that of trajectory 0 {expected}; give all the same"
    )]
    ContextDimensions {
        /// The first trajectory that differs.
        trajectory: usize,
        /// Its number of dimensions.
        found: usize,
        /// The number of dimensions of trajectory 0.
        expected: usize,
    },
    /// The share to hold out is not between 0 and 1.
    #[error("share {fraction} of what is held out: it must be more than 0 and less than 1")]
    Fraction {
        /// The given share.
        fraction: f64,
    },
    /// One of several trajectories is not valid.
    #[error("trajectory {trajectory}: {source}")]
    InTrajectory {
        /// Index of the trajectory.
        trajectory: usize,
        /// Its fault.
        source: Box<MotionError>,
    },
}
