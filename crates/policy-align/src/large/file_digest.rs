use serde::{Deserialize, Serialize};

use crate::Digest;

/// The digest of one of the further files.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FileDigest {
    /// Its place among them.
    pub(super) at: usize,
    pub(super) name: String,
    pub(super) bytes: u64,
    pub(super) digest: Digest,
}
