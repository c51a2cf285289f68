use serde::{Deserialize, Serialize};

/// Whether a policy may be used. The worst of its findings decides.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Nothing was found against it.
    Good,
    /// Look before you use it.
    Doubtful,
    /// It is wrong, or nothing tells whether it is right.
    DoNotUse,
}

/// One reason to doubt a policy.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Finding {
    /// How much it weighs.
    pub verdict: Verdict,
    /// What was found, in one sentence with its number.
    pub what: String,
    /// What to do next.
    pub next: String,
}
