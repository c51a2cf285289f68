use prepare::numbers::short;
use thiserror::Error;

/// Reasons why a model cannot command a robot. The part of a message after the last semicolon
/// suggests the next step.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ControllerError {
    /// The policy depends on a context that is not fixed.
    #[error("the policy depends on {}; choose a value for each", .names.join(", "))]
    Context {
        /// Channels of the context.
        names: Vec<String>,
    },
    /// A number is not positive and finite.
    #[error("{name} is {}; it must be positive and finite", short(*.value))]
    NotPositive {
        /// "stale" or "max-speed".
        name: &'static str,
        /// The given value.
        value: f64,
    },
    /// A joint is assigned to a channel that the model does not have.
    #[error("the model has no channel '{channel}'; it has {}", .channels.join(", "))]
    UnknownChannel {
        /// The given name.
        channel: String,
        /// The model's channels.
        channels: Vec<String>,
    },
    /// A channel or a joint is named twice.
    #[error("'{name}' is named twice; each channel is one joint")]
    Twice {
        /// The channel or the joint.
        name: String,
    },
    /// Some channels have no joint.
    #[error("no joint for {}; name one for every channel", .channels.join(", "))]
    NoJoint {
        /// The channels.
        channels: Vec<String>,
    },
}
