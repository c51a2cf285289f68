use std::borrow::Cow;

use prepare::numbers::{counted, short};
use thiserror::Error;

/// Reasons why a policy cannot be rolled out. The message describes the fault and its place;
/// [`RollOutError::remedy`] suggests the next step.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum RollOutError {
    /// The policy depends on a context that is not fixed.
    #[error("the policy depends on {}", .names.join(", "))]
    Context {
        /// Channels of the context.
        names: Vec<String>,
    },
    /// The start has another length than the state.
    #[error("the start has {}, the state {expected}: {}", counted(*found, "number"), .names.join(", "))]
    Start {
        /// Number of given values.
        found: usize,
        /// Number of channels of the state.
        expected: usize,
        /// Their names.
        names: Vec<String>,
    },
    /// The start is not finite.
    #[error("the start is not finite in channel '{channel}'")]
    StartNotFinite {
        /// Name of the channel.
        channel: String,
    },
    /// The start is outside the data.
    #[error("the start is outside the data (support {}, at least {} needed)", short(down(*.support)), short(*.least))]
    Unsupported {
        /// The support there.
        support: f64,
        /// The support needed.
        least: f64,
        /// The demonstrated range of each channel, by name.
        ranges: Vec<(String, [f64; 2])>,
    },
    /// The fixed context is outside the data.
    #[error("context {name}={} is outside the data", short(*.value))]
    ContextUnsupported {
        /// Its channel.
        name: String,
        /// Its value.
        value: f64,
        /// The supported range.
        range: [f64; 2],
    },
    /// A constraint does not allow the start.
    #[error("the start breaks constraint {constraint} by {by:.3e}")]
    StartBreaks {
        /// Its number, counted from 1, as in its file.
        constraint: usize,
        /// Depth inside a ball.
        by: f64,
    },
    /// The start is beyond a joint limit.
    #[error("the start is beyond the limit of joint '{joint}'")]
    StartBeyondLimit {
        /// Name of the joint.
        joint: String,
    },
    /// A duration or a step is invalid.
    #[error("{name} is {}: it must be positive and finite", short(*.value))]
    NotPositive {
        /// Name of the option, such as "seconds".
        name: &'static str,
        /// The given value.
        value: f64,
    },
    /// More samples than the limit.
    #[error("{samples:.1e} samples exceed the limit of {} million", LONGEST / 1_000_000)]
    TooLong {
        /// Number of samples.
        samples: f64,
    },
    /// The policy's action is not finite at a state that was reached.
    #[error("the action is not finite at {time:.3} s, in state {}", .state.iter().map(|x| short(*x)).collect::<Vec<_>>().join(", "))]
    NotFinite {
        /// Seconds from the start.
        time: f64,
        /// The state, in the units of the recording.
        state: Vec<f64>,
    },
    /// The integration was given up.
    #[error("more than {limit} steps of integration are needed: {} s of {} s were reached", short(*.time), short(*.seconds))]
    TooManySteps {
        /// Largest number of steps.
        limit: usize,
        /// Seconds reached.
        time: f64,
        /// Seconds requested.
        seconds: f64,
    },
    /// A constraint cannot be computed at a state.
    #[error("constraint {constraint} has no value at {time:.3} s: {reason}")]
    Constraint {
        /// Its number, counted from 1, as in its file.
        constraint: usize,
        /// Seconds from the start.
        time: f64,
        /// The reason.
        reason: String,
    },
}

/// Rounds down to three digits, so that an insufficient support does not appear sufficient.
fn down(support: f64) -> f64 {
    (1e3 * support).floor() / 1e3
}

/// Largest number of samples of a roll-out.
pub(crate) const LONGEST: usize = 10_000_000;

impl RollOutError {
    /// Suggestion for the next step.
    pub fn remedy(&self) -> Cow<'static, str> {
        Cow::Borrowed(match self {
            RollOutError::Unsupported { ranges, .. } => {
                let range =
                    |(name, [low, high]): &(String, [f64; 2])| format!("{name} {} … {}", short(*low), short(*high));
                let ranges: Vec<String> = ranges.iter().map(range).collect();
                return Cow::Owned(format!("start near a demonstration, within {}", ranges.join(", ")));
            }
            RollOutError::ContextUnsupported { name, range: [low, high], .. } => {
                return Cow::Owned(format!("a context within {name} {} … {}", short(*low), short(*high)));
            }
            RollOutError::Context { .. } => "--context with NAME=VALUE for each",
            RollOutError::Start { .. } => "give one number for each channel, in this order",
            RollOutError::StartNotFinite { .. } => "give finite numbers",
            RollOutError::StartBreaks { .. } => "start outside the ball, or make it smaller",
            RollOutError::StartBeyondLimit { .. } => "start within the limits, in radians or metres",
            RollOutError::NotPositive { .. } => "give a time in seconds",
            RollOutError::TooLong { .. } => "a longer step or fewer seconds",
            RollOutError::NotFinite { .. } => "another start, or fit again: this model is damaged or was altered",
            RollOutError::TooManySteps { .. } => {
                "fewer seconds; if that is not enough, larger balls, or fit again: actions change too fast to be followed"
            }
            RollOutError::Constraint { .. } => "correct the constraint file or the robot description",
        })
    }
}
