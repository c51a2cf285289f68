use align::AlignError;
use gp::GpError;
use thiserror::Error;

/// Why nothing was learnt.
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
        /// The value given.
        value: f64,
        /// What it must satisfy.
        requirement: &'static str,
    },
    /// A robot's mass matrix cannot be used.
    #[error("robot: {reason}")]
    Robot {
        /// Why.
        reason: String,
    },
    /// The learner has no use for a context.
    #[error("PolicyAlign cannot learn what depends on a context ({context}); --learner auto, or --context none")]
    Context {
        /// Its channels.
        context: String,
    },
    /// Digests of further recordings cannot be used.
    #[error("further recordings: {reason}")]
    Digest {
        /// Why.
        reason: String,
    },
    /// A Gaussian process refuses.
    #[error(transparent)]
    Gp(#[from] GpError),
    /// PolicyAlign refuses.
    #[error(transparent)]
    Align(#[from] AlignError),
    /// Positions cannot be smoothed.
    #[error(transparent)]
    Smoothing(#[from] smoothing::SmoothingError),
}
