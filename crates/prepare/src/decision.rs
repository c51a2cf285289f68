use serde::{Deserialize, Serialize};

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
