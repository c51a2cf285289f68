use std::borrow::Cow;

use prepare::numbers::{counted, short};
use thiserror::Error;

/// Why a policy cannot be followed. A message says what and where; [`RollOutError::remedy`] what next.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum RollOutError {
    /// The policy depends on a context, and none was chosen.
    #[error("the policy depends on {}", .names.join(", "))]
    Context {
        /// Channels of the context.
        names: Vec<String>,
    },
    /// The start has another length than the state.
    #[error("the start has {}, the state {expected}: {}", counted(*found, "number"), .names.join(", "))]
    Start {
        /// Numbers given.
        found: usize,
        /// Channels of the state.
        expected: usize,
        /// Their names.
        names: Vec<String>,
    },
    /// The start is not finite.
    #[error("the start is not finite in channel '{channel}'")]
    StartNotFinite {
        /// Which.
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
    /// The context that was chosen is outside the data.
    #[error("context {name}={} is outside the data", short(*.value))]
    ContextUnsupported {
        /// Its channel.
        name: String,
        /// What was chosen.
        value: f64,
        /// The range that counts as known.
        range: [f64; 2],
    },
    /// A constraint does not allow the start.
    #[error("the start breaks constraint {constraint} by {by:.3e}")]
    StartBreaks {
        /// Counted from 1, as in its file.
        constraint: usize,
        /// How far inside a ball.
        by: f64,
    },
    /// Beyond a joint limit from the beginning.
    #[error("the start is beyond the limit of joint '{joint}'")]
    StartBeyondLimit {
        /// Which.
        joint: String,
    },
    /// A duration or a step that cannot be.
    #[error("{name} is {}: it must be positive and finite", short(*.value))]
    NotPositive {
        /// "seconds".
        name: &'static str,
        /// What was given.
        value: f64,
    },
    /// More samples than the limit.
    #[error("{samples:.1e} samples exceed the limit of {} million", LONGEST / 1_000_000)]
    TooLong {
        /// How many it would be.
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
        /// How many are taken at most.
        limit: usize,
        /// Seconds reached.
        time: f64,
        /// Seconds asked for.
        seconds: f64,
    },
    /// A constraint cannot be computed at a state.
    #[error("constraint {constraint} has no value at {time:.3} s: {reason}")]
    Constraint {
        /// Counted from 1, as in its file.
        constraint: usize,
        /// Seconds from the start.
        time: f64,
        /// What is wrong.
        reason: String,
    },
}

/// To three digits, so that what is too little does not round to enough.
fn down(support: f64) -> f64 {
    (1e3 * support).floor() / 1e3
}

/// Samples of a roll-out, at most.
pub(crate) const LONGEST: usize = 10_000_000;

impl RollOutError {
    /// The next step.
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
