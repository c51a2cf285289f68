use thiserror::Error;

/// Reasons why nothing was learnt. All numbers count from 0.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum GpError {
    /// A parameter is outside its range.
    #[error("{name} is {value}: it must {requirement}")]
    Parameter {
        /// Name of the field.
        name: &'static str,
        /// The given value.
        value: f64,
        /// The condition on the value.
        requirement: &'static str,
    },
    /// Lists that belong together have different lengths.
    #[error("there are {found} {what} for {expected} rows; give one each")]
    Lengths {
        /// Name of the list.
        what: &'static str,
        /// Its length.
        found: usize,
        /// Number of rows.
        expected: usize,
    },
    /// A number is NaN or infinite, or a variance is negative.
    #[error("row {row}: {what} {value} is not valid; leave the row out")]
    Value {
        /// State, velocity or variance.
        what: &'static str,
        /// Index of the row.
        row: usize,
        /// The value.
        value: f64,
    },
    /// The front end needs velocities that were not recorded.
    #[error(
        "trajectory {trajectory} has no recorded velocities; add them with Trajectory::with_velocities or choose a front end that needs only positions"
    )]
    NoVelocities {
        /// The first trajectory without velocities.
        trajectory: usize,
    },
    /// Squares of the data exceed the range of f64.
    #[error("the square of a {what} overflows, or all of them underflow; use other units")]
    Overflow {
        /// Speed or distance.
        what: &'static str,
    },
    /// Nothing moves.
    #[error("nothing moves: all velocities are 0; there is nothing to learn from")]
    NoMotion,
    /// Every row is at the same state.
    #[error("all rows are at one state; movements must pass through several")]
    OneState,
    /// All movements are too short for the request.
    #[error(
        "no movement has {needed} samples, the longest has {longest}; record longer movements or more samples a second"
    )]
    ShortMovements {
        /// Number of samples of the longest movement.
        longest: usize,
        /// Number of samples that at least one movement needs.
        needed: usize,
    },
    /// There are too few groups to leave one out.
    #[error("only {found} trajectories have rows that can be used, at least 3 are needed; record more")]
    TooFewTrajectories {
        /// Number of trajectories, or blocks of time, that have rows.
        found: usize,
    },
    /// There are too few rows for a model.
    #[error("only {found} rows can be used, at least {needed} are needed; record more samples or reduce noise")]
    TooFewRows {
        /// Number of remaining rows.
        found: usize,
        /// Minimum: the dimension plus two.
        needed: usize,
    },
    /// No family's covariance has a Cholesky factor.
    #[error("no family's covariance matrix has a Cholesky factor: rows repeat each other exactly; thin the recordings")]
    NoFactor,
    /// Trajectories cannot be smoothed or fused.
    #[error("the recordings cannot be smoothed: {reason}")]
    Cleaning {
        /// The smoother's explanation.
        reason: String,
    },
    /// The stored data are not a valid model.
    #[error("the stored model cannot be used: {reason}")]
    Stored {
        /// Description of the fault.
        reason: String,
    },
}
