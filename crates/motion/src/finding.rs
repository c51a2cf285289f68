use std::fmt;

use serde::{Deserialize, Serialize};

/// Whether a policy may be used; determined by the worst of its findings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// All checks passed.
    Good,
    /// Check the findings before using it.
    Doubtful,
    /// The policy is wrong, or no data test it.
    DoNotUse,
}

impl Verdict {
    /// The verdict of the worst finding; good if there is none.
    pub fn worst(findings: &[Finding]) -> Self {
        findings.iter().map(|finding| finding.verdict).max().unwrap_or(Verdict::Good)
    }
}

/// An anomaly of recordings or a policy. Findings with [`Verdict::Good`] are remarks.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Finding {
    /// Its severity.
    pub verdict: Verdict,
    /// The finding, in one sentence with its number and place.
    pub what: String,
    /// The next step.
    pub next: String,
    /// What it is about. Files do not store it, so findings are equal without it.
    #[serde(skip)]
    pub topic: Topic,
}

/// Findings that later steps withdraw or resolve.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Topic {
    /// None of these.
    #[default]
    Other,
    /// A channel in another unit than the others.
    MixedUnits,
    /// A direction in which the velocity is the same everywhere.
    Pressing,
    /// A speed limit.
    SpeedLimit,
}

impl Topic {
    /// Whether the scales of channels determine the finding.
    pub fn depends_on_scale(self) -> bool {
        self != Topic::Other
    }
}

impl PartialEq for Finding {
    fn eq(&self, other: &Self) -> bool {
        (self.verdict, &self.what, &self.next) == (other.verdict, &other.what, &other.next)
    }
}

impl Eq for Finding {}

impl Finding {
    /// A finding of some severity.
    pub fn new(verdict: Verdict, what: impl Into<String>, next: impl Into<String>) -> Self {
        Finding { verdict, what: what.into(), next: next.into(), topic: Topic::Other }
    }

    /// The same about a topic.
    #[must_use]
    pub fn on(self, topic: Topic) -> Self {
        Finding { topic, ..self }
    }

    /// A finding with [`Verdict::Doubtful`].
    pub fn doubt(what: impl Into<String>, next: impl Into<String>) -> Self {
        Finding::new(Verdict::Doubtful, what, next)
    }

    /// A finding with [`Verdict::Good`].
    pub fn remark(what: impl Into<String>, next: impl Into<String>) -> Self {
        Finding::new(Verdict::Good, what, next)
    }
}

/// An automatic decision, with its reason and the flag that overrides it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Decision {
    /// The subject.
    pub what: Subject,
    /// The choice, for instance "velocity".
    pub value: String,
    /// The reason, for instance "recorded; they agree with the steps".
    pub why: String,
    /// The flag, for instance "--integration".
    pub flag: String,
}

impl Decision {
    /// A decision with the flag of its subject.
    pub fn new(what: Subject, value: impl Into<String>, why: impl Into<String>) -> Self {
        Decision { what, value: value.into(), why: why.into(), flag: what.flag().to_owned() }
    }

    /// The same with another flag.
    #[must_use]
    pub fn with_flag(self, flag: &str) -> Self {
        Decision { flag: flag.to_owned(), ..self }
    }
}

/// The subject of a decision. In files and texts it is a word: "time step".
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Subject {
    /// Time between samples.
    #[serde(rename = "time step")]
    TimeStep,
    /// Unit of a channel.
    Scale,
    /// Channels that are constant during a movement.
    Context,
    /// Signs of quaternions.
    Quaternions,
    /// Whole turns of an angle.
    Angles,
    /// Movements that were split where they jump, and samples that were interpolated.
    Jumps,
    /// Labels of constraints that change during a movement.
    Switches,
    /// Source of the velocities.
    Velocities,
    /// Velocities that lag behind the positions.
    #[serde(rename = "shift of velocities")]
    ShiftOfVelocities,
    /// Smoothing of positions and velocities.
    Smoothing,
    /// Consecutive samples averaged to one.
    Averaging,
    /// Samples that are in memory together.
    #[serde(rename = "at once")]
    AtOnce,
    /// Equations of a Gaussian process.
    Rows,
    /// The learner: PolicyAlign, slope GP or direct GP.
    Learner,
    /// Lengths in the space of a robot's joints.
    Metric,
    /// Coordinates in which constraints are constant.
    #[serde(rename = "task space")]
    TaskSpace,
    /// How the potential along a movement is integrated.
    Integration,
    /// How near two movements must pass to be aligned.
    Bandwidth,
    /// Initial size of a receptive field.
    InitD,
}

impl Subject {
    /// The flag that overrides its decisions.
    pub fn flag(self) -> &'static str {
        match self {
            Subject::TimeStep => "--dt",
            Subject::Scale => "--scale",
            Subject::Context => "--context",
            Subject::Quaternions | Subject::Angles => "--wraps",
            Subject::Jumps => "--jumps",
            Subject::Switches => "--constraint-column",
            Subject::Velocities | Subject::ShiftOfVelocities | Subject::Integration => "--integration",
            Subject::Smoothing | Subject::Averaging => "--smooth",
            Subject::AtOnce => "--at-once",
            Subject::Rows => "--max-rows",
            Subject::Learner => "--learner",
            Subject::Metric | Subject::TaskSpace => "--robot",
            Subject::Bandwidth => "--bandwidth",
            Subject::InitD => "--init-d",
        }
    }
}

impl fmt::Display for Subject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.serialize(f)
    }
}

/// An episode that was not used.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LeftOut {
    /// Its name.
    pub episode: String,
    /// The reason, for instance "never moves".
    pub why: String,
}
