use serde::{Deserialize, Serialize};

/// Whether constraints A u = b may have b ≠ 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PushTest {
    /// b = 0, as in the paper: one search, on rows of samples.
    #[default]
    AssumeNone,
    /// If a push is detected (S24), also searches on rows of stretches (S22). The search that predicts left-out
    /// movements better is kept.
    Fit,
}

impl PushTest {
    #[allow(clippy::trivially_copy_pass_by_ref)] // serde wants it
    pub(crate) fn is_off(&self) -> bool {
        *self == PushTest::AssumeNone
    }
}
