use demo_io::ReadError;
use thiserror::Error;

use crate::PrepareError;

/// Reasons why a part cannot be made, or parts cannot be used.
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
        /// The system's error message.
        reason: String,
    },
    /// A file cannot be reduced to a digest.
    #[error("{file}: {source}")]
    Digest {
        /// Its name.
        file: String,
        /// The reason.
        source: Box<DigestError>,
    },
    /// Some of several parts do not fit.
    #[error("{reason}")]
    Unfit {
        /// Their indices, counted from 0.
        parts: Vec<usize>,
        /// The reason.
        reason: String,
    },
    /// Parts are damaged, missing, or made from other files.
    #[error("{reason}")]
    Parts {
        /// The reason.
        reason: String,
    },
}

/// Reasons why recordings cannot be reduced to a digest.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum DigestError {
    /// The recordings cannot be prepared.
    #[error(transparent)]
    Prepare(#[from] PrepareError),
    /// Their samples cannot be converted to rows.
    #[error(transparent)]
    Fit(#[from] crate::FitError),
    /// They differ from the recordings at hand.
    #[error("{what} are {here} here, but {before} in the others")]
    Differs {
        /// The property that differs.
        what: String,
        /// Its value here.
        here: String,
        /// Its value in the others.
        before: String,
    },
}
