use motion::{Finding, Verdict};
use serde::{Deserialize, Serialize};

use super::numbers::TrustNumbers;

/// How far a policy can be trusted; computed without knowing the truth.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Trust {
    /// The verdict of the worst finding; good if there is none.
    pub verdict: Verdict,
    /// The findings, the worst first; those with the verdict good are remarks.
    pub findings: Vec<Finding>,
    /// The numbers behind the verdict.
    pub numbers: TrustNumbers,
}
