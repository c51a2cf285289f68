use thiserror::Error;

/// Why nothing could be learnt. All numbers count from 0.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum GpError {
    /// A parameter lies outside its range.
    #[error("{name} is {value}: it must {requirement}")]
    Parameter {
        /// Name of the field.
        name: &'static str,
        /// The value given.
        value: f64,
        /// What the value must satisfy.
        requirement: &'static str,
    },
    /// Lists that belong together differ in length.
    #[error("there are {found} {what} for {expected} rows; give one each")]
    Lengths {
        /// What is too many or too few.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many rows there are.
        expected: usize,
    },
    /// A number is NaN or infinite, or a variance negative.
    #[error("row {row}: a {what} of {value} cannot be; leave the row out")]
    Value {
        /// State, velocity or variance.
        what: &'static str,
        /// The row.
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
    /// Squares of the data leave the range of f64.
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
    /// Movements too short for what is asked.
    #[error(
        "no movement has {needed} samples, the longest has {longest}; record longer movements or more samples a second"
    )]
    ShortMovements {
        /// Samples of the longest.
        longest: usize,
        /// Samples needed in at least one.
        needed: usize,
    },
    /// Too few groups for leaving one out.
    #[error("only {found} trajectories have rows that can be used, at least 3 are needed; record more")]
    TooFewTrajectories {
        /// How many trajectories, or blocks of time, have rows.
        found: usize,
    },
    /// Too few rows for a model.
    #[error("only {found} rows can be used, at least {needed} are needed; record more or less noisily")]
    TooFewRows {
        /// How many rows are left.
        found: usize,
        /// Dimension plus two.
        needed: usize,
    },
    /// No family's covariance has a Cholesky factor.
    #[error("no family's covariance matrix has a Cholesky factor: rows repeat each other exactly; thin the recordings")]
    NoFactor,
    /// Trajectories cannot be smoothed or fused.
    #[error("the recordings cannot be smoothed: {reason}")]
    Cleaning {
        /// The smoother's own words.
        reason: String,
    },
    /// The stored data are not a model.
    #[error("the stored model cannot be used: {reason}")]
    Stored {
        /// What is wrong with it.
        reason: String,
    },
}
