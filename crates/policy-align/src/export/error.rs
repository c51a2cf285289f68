use thiserror::Error;

/// Why a model cannot be exported.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum ExportError {
    /// Nothing of the policy can be written down.
    #[error("the policy is zero everywhere: no receptive field was learnt")]
    Nothing,
    /// Not a name in C.
    #[error(
        "'{name}' is not a C name: letters, digits and _, not starting with a digit, no keyword and no name of math.h"
    )]
    Name {
        /// What was given.
        name: String,
    },
    /// The model cannot be stored.
    #[error("the model cannot be stored: {reason}")]
    Unwritable {
        /// What [`ModelError`](crate::ModelError) says.
        reason: String,
    },
}
