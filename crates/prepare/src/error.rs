use motion::MotionError;
use thiserror::Error;

/// Why recordings cannot be learnt from. Samples count from 0.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum PrepareError {
    /// There is nothing.
    #[error("there is no episode; give at least one")]
    Empty,
    /// Nothing is left.
    #[error("all {of} episodes were left out ({why}); record movements")]
    NothingLeft {
        /// How many there were.
        of: usize,
        /// Why the first was left out.
        why: String,
    },
    /// Few samples of many dimensions: rows and columns may be exchanged, and otherwise there is hardly anything to learn from.
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
    /// A scale for something that is not there.
    #[error("--scale names '{name}', but the state has {known}; use one of these names")]
    UnknownChannel {
        /// The name given.
        name: String,
        /// The names there are.
        known: String,
    },
    /// A scale that is not positive and finite.
    #[error("--scale {name}={factor}: a scale must be positive and finite")]
    Scale {
        /// The channel.
        name: String,
        /// The factor given.
        factor: f64,
    },
    /// A time step that is not positive and finite.
    #[error("--dt {time_step} is not positive and finite; give seconds between samples")]
    TimeStep {
        /// The time step given.
        time_step: f64,
    },
    /// A window that cannot smooth.
    #[error(
        "--smooth: a window of {window} samples, {step} s apart; an odd number of at least 5, as in --smooth 9, or seconds, as in --smooth {}s", crate::numbers::short(9.0 * step)
    )]
    Smoothing {
        /// Samples in it.
        window: usize,
        /// Seconds between them.
        step: f64,
    },
    /// A context that is none.
    #[error("--context names '{name}', but {why}")]
    Context {
        /// The name given.
        name: String,
        /// Why it cannot be one, and what can.
        why: String,
    },
    /// An episode is not a movement.
    #[error("episode '{episode}': {source}")]
    Episode {
        /// Its name.
        episode: String,
        /// What is wrong with it.
        source: MotionError,
    },
}
