use thiserror::Error;

/// Reasons why a model cannot be exported.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum ExportError {
    /// The policy is empty.
    #[error("the policy is zero everywhere: no receptive field was learnt")]
    Nothing,
    /// The name is not valid in C.
    #[error(
        "'{name}' is not a C name: letters, digits and _, not starting with a digit, no keyword and no name of math.h"
    )]
    Name {
        /// The given name.
        name: String,
    },
    /// The model cannot be stored.
    #[error("the model cannot be stored: {reason}")]
    Unwritable {
        /// Text of the [`ModelError`](crate::ModelError).
        reason: String,
    },
}
