use prepare::numbers::short;
use thiserror::Error;

/// Why a model cannot command a robot. A message says what, and after its last semicolon what next.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ControllerError {
    /// The policy depends on a context, and none was chosen.
    #[error("the policy depends on {}; choose a value for each", .names.join(", "))]
    Context {
        /// Channels of the context.
        names: Vec<String>,
    },
    /// A number that must be positive and finite.
    #[error("{name} is {}; it must be positive and finite", short(*.value))]
    NotPositive {
        /// "stale" or "max-speed".
        name: &'static str,
        /// What was given.
        value: f64,
    },
    /// A joint is given to a channel that the model lacks.
    #[error("the model has no channel '{channel}'; it has {}", .channels.join(", "))]
    UnknownChannel {
        /// The name given.
        channel: String,
        /// The channels there are.
        channels: Vec<String>,
    },
    /// A channel or a joint is named twice.
    #[error("'{name}' is named twice; each channel is one joint")]
    Twice {
        /// The channel or the joint.
        name: String,
    },
    /// Channels without a joint.
    #[error("no joint for {}; name one for every channel", .channels.join(", "))]
    NoJoint {
        /// The channels.
        channels: Vec<String>,
    },
}
