use serde::{Deserialize, Serialize};

/// Something that was decided for the user, who sees it as one line and can override it.
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
