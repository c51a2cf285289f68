use motion::MotionError;
use thiserror::Error;

/// Reasons why recordings cannot be learnt from. Samples count from 0.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum PrepareError {
    /// There are no episodes.
    #[error("there is no episode; give at least one")]
    Empty,
    /// No episode remains.
    #[error("all {of} episodes were left out ({why}); record movements")]
    NothingLeft {
        /// Number of episodes before.
        of: usize,
        /// The reason for leaving out the first.
        why: String,
    },
    /// Few samples of many dimensions: rows and columns may be swapped, or there is hardly anything to learn from.
    #[error(
        "the state has {dim} dimensions and the longest episode {longest} samples, {samples} in all: rows and columns seem to be exchanged, or samples are too few; --samples-are with the other orientation, or record more"
    )]
    LooksTransposed {
        /// Dimensions of the state.
        dim: usize,
        /// Samples of the longest episode.
        longest: usize,
        /// Samples of all episodes.
        samples: usize,
    },
    /// A scale for a channel that does not exist.
    #[error("--scale names '{name}', but the state has {known}; use one of these names")]
    UnknownChannel {
        /// The given name.
        name: String,
        /// The existing names.
        known: String,
    },
    /// A scale that is not positive and finite.
    #[error("--scale {name}={factor}: a scale must be positive and finite")]
    Scale {
        /// The channel.
        name: String,
        /// The given factor.
        factor: f64,
    },
    /// A time step that is not positive and finite.
    #[error("--dt {time_step} is not positive and finite; give seconds between samples")]
    TimeStep {
        /// The given time step.
        time_step: f64,
    },
    /// A window that is not suitable for smoothing.
    #[error(
        "--smooth: a window of {window} samples, {step} s apart; an odd number of at least 5, as in --smooth 9, or seconds, as in --smooth {}s", crate::numbers::short(9.0 * step)
    )]
    Smoothing {
        /// Number of samples in the window.
        window: usize,
        /// Seconds between samples.
        step: f64,
    },
    /// A context that is not valid.
    #[error("--context names '{name}', but {why}")]
    Context {
        /// The given name.
        name: String,
        /// Reason, and valid alternatives.
        why: String,
    },
    /// An episode is not a movement.
    #[error("episode '{episode}': {source}")]
    Episode {
        /// Name of the episode.
        episode: String,
        /// Description of the fault.
        source: MotionError,
    },
}
