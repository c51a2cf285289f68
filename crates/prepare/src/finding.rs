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

/// One reason to doubt a policy.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Finding {
    /// Its severity.
    pub verdict: Verdict,
    /// The finding, in one sentence with its number.
    pub what: String,
    /// The next step.
    pub next: String,
}
