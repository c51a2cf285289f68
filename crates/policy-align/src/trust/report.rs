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
