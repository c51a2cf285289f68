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

/// An anomaly of recordings or a policy. Findings with [`Verdict::Good`] are remarks.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Finding {
    /// Its severity.
    pub verdict: Verdict,
    /// The finding, in one sentence with its number and place.
    pub what: String,
    /// The next step.
    pub next: String,
}

/// An automatic decision, with its reason and the flag that overrides it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Decision {
    /// The subject, for instance "integration".
    pub what: String,
    /// The choice, for instance "velocity".
    pub value: String,
    /// The reason, for instance "recorded; they agree with the steps".
    pub why: String,
    /// The flag, for instance "--integration".
    pub flag: String,
}

/// An episode that was not used.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LeftOut {
    /// Its name.
    pub episode: String,
    /// The reason, for instance "not connected".
    pub why: String,
}
