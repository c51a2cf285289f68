use motion::{Finding, Verdict};
use serde::{Deserialize, Serialize};

use super::numbers::TrustNumbers;

/// How far to trust a policy; computed without knowing the truth.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Trust {
    /// The worst of the findings; good if there is none.
    pub verdict: Verdict,
    /// Why, the worst first; those called good are mere remarks.
    pub findings: Vec<Finding>,
    /// The numbers behind it.
    pub numbers: TrustNumbers,
}

impl Trust {
    /// The verdict that follows from findings.
    pub(crate) fn verdict_of(findings: &[Finding]) -> Verdict {
        findings.iter().map(|finding| finding.verdict).max().unwrap_or(Verdict::Good)
    }
}
