use demo_io::ReadError;
use gp::GpError;
use thiserror::Error;

use crate::PrepareError;

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
        source: Box<DigestError>,
    },
    /// Some of several parts do not belong there.
    #[error("{reason}")]
    Unfit {
        /// Which of them, counted from 0.
        parts: Vec<usize>,
        /// Why.
        reason: String,
    },
    /// Parts are damaged, missing, or of other files.
    #[error("{reason}")]
    Parts {
        /// Why.
        reason: String,
    },
}

/// Why there is no digest of some recordings.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum DigestError {
    /// They cannot be prepared.
    #[error(transparent)]
    Prepare(#[from] PrepareError),
    /// Their samples do not become rows.
    #[error(transparent)]
    Gp(#[from] GpError),
    /// They are not like those that they are to be learnt from with.
    #[error("{what} are {here} here, but {before} in the others")]
    Differs {
        /// In what.
        what: String,
        /// What it is here.
        here: String,
        /// What it is in the others.
        before: String,
    },
}
