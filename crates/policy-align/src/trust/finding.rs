use serde::{Deserialize, Serialize};

use super::numbers::TrustNumbers;

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

/// How far to trust a policy; computed without knowing the truth.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Trust {
    /// The worst of the findings; good if there is none.
    pub verdict: Verdict,
    /// Why, the worst first; those called good are mere remarks.
    pub findings: Vec<Finding>,
    /// What it rests on.
    pub numbers: TrustNumbers,
}
