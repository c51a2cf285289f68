use demo_io::ReadError;
use thiserror::Error;

use crate::DigestError;

/// Why there is no part, or why parts cannot be used.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum PartError {
    /// A file cannot be read as recordings.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// A file cannot be read.
    #[error("{file}: {reason}")]
    File {
        /// Its name.
        file: String,
        /// What the system says.
        reason: String,
    },
    /// There is no digest of it.
    #[error("{file}: {source}")]
    Digest {
        /// Its name.
        file: String,
        /// Why.
        source: DigestError,
    },
    /// Parts are damaged, missing, or of other files.
    #[error("{reason}")]
    Parts {
        /// Why.
        reason: String,
    },
}
