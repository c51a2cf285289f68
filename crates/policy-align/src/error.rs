use align::AlignError;
use gp::GpError;
use thiserror::Error;

/// Reasons why a fit fails.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum FitError {
    /// The fit was cancelled.
    #[error("stopped on request; nothing was learnt")]
    Cancelled,
    /// An option lies outside its range.
    #[error("{name} is {value}: it must {requirement}")]
    Option {
        /// Its flag.
        name: &'static str,
        /// The given value.
        value: f64,
        /// The condition that it must satisfy.
        requirement: &'static str,
    },
    /// A robot's mass matrix cannot be used.
    #[error("robot: {reason}")]
    Robot {
        /// The reason.
        reason: String,
    },
    /// The learner does not support a context.
    #[error("PolicyAlign cannot learn what depends on a context ({context}); --learner auto, or --context none")]
    Context {
        /// Its channels.
        context: String,
    },
    /// Digests of further recordings cannot be used.
    #[error("further recordings: {reason}")]
    Digest {
        /// The reason.
        reason: String,
    },
    /// Movements in other units, averaged or differenced, are not valid.
    #[error("the movements cannot be learnt from: {0}")]
    Motion(#[from] motion::MotionError),
    /// Error of a Gaussian process.
    #[error(transparent)]
    Gp(#[from] GpError),
    /// Error of PolicyAlign.
    #[error(transparent)]
    Align(#[from] AlignError),
    /// Positions cannot be smoothed.
    #[error(transparent)]
    Smoothing(#[from] smoothing::SmoothingError),
}
