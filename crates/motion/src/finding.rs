use serde::{Deserialize, Serialize};

/// Whether a policy may be used. The worst of its findings decides.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// All checks passed.
    Good,
    /// Check the findings before using it.
    Doubtful,
    /// It is wrong, or no data test it.
    DoNotUse,
}

/// Something odd about recordings or a policy. Those of [`Verdict::Good`] are remarks.
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
    /// "integration".
    pub what: String,
    /// "velocity".
    pub value: String,
    /// "recorded; they agree with the steps".
    pub why: String,
    /// "--integration".
    pub flag: String,
}

/// An episode that was not used.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LeftOut {
    /// Its name.
    pub episode: String,
    /// "not connected".
    pub why: String,
}
