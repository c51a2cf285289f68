use motion::MotionError;
use thiserror::Error;

/// Reasons why movements cannot be cleaned. All numbers count from 0.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum SmoothingError {
    /// A parameter lies outside its range.
    #[error("{name} is {value}: it must {requirement}")]
    Parameter {
        /// Name of the field.
        name: &'static str,
        /// The given value.
        value: f64,
        /// The condition that the value must satisfy.
        requirement: &'static str,
    },
    /// No degree of the polynomials was given.
    #[error("degrees is empty, so that no polynomial can be fitted; name one or more, 0 or 1 among them")]
    NoDegrees,
    /// The movements themselves are invalid.
    #[error(transparent)]
    Motion(#[from] MotionError),
    /// The scale of an axis is missing or superfluous.
    #[error("{found} axis scales were given for {expected} dimensions; give one per dimension")]
    AxisScales {
        /// Number of scales.
        found: usize,
        /// Dimension of the state.
        expected: usize,
    },
    /// No axis moves.
    #[error("no dimension ever changes, so there is no movement to smooth; record one")]
    NoMotion,
    /// Squares of the coordinates leave the range of f64.
    #[error("the coordinates are so large that their squares overflow; use larger units of length")]
    Overflow,
    /// Fusion needs velocities that were not recorded.
    #[error(
        "trajectory {trajectory} has no recorded velocities to fuse with; add them with Trajectory::with_velocities or use Smoother"
    )]
    NoVelocities {
        /// The first trajectory without velocities.
        trajectory: usize,
    },
    /// There are too few consecutive samples to distinguish noise from movement.
    #[error("{found} third differences are too few to estimate noise, {needed} are needed; record more samples")]
    TooFewDifferences {
        /// Number found.
        found: usize,
        /// Number needed.
        needed: usize,
    },
}

/// Refuses a parameter unless `fine`.
pub(crate) fn require(
    fine: bool,
    name: &'static str,
    value: f64,
    requirement: &'static str,
) -> Result<(), SmoothingError> {
    if fine { Ok(()) } else { Err(SmoothingError::Parameter { name, value, requirement }) }
}
