use std::io;

use thiserror::Error;

/// Why a text is not a model, or a model cannot be stored. Paths are those of JSON: `learnt.slope.directions[3]`.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ModelError {
    /// The text begins as JSON, but is none.
    #[error("damaged or cut off: not JSON ({reason})")]
    NotJson {
        /// What the JSON reader says.
        reason: String,
    },
    /// Something else.
    #[error("not a policy-align model: {found}")]
    NotAModel {
        /// What it is, or what says so.
        found: String,
    },
    /// Made by a newer program.
    #[error("made by a newer policy-align: model version {found}, this one reads up to {known}")]
    Newer {
        /// The version of the file.
        found: u64,
        /// The newest version that is understood.
        known: u64,
    },
    /// A member is missing, has another type, or cannot be.
    #[error("{path}: {reason}{}", if *.changed { "; the checksum differs too: the file was changed" } else { "" })]
    Member {
        /// Where.
        path: String,
        /// What is wrong there.
        reason: String,
        /// Whether the checksum is wrong as well.
        changed: bool,
    },
    /// What is there is not what was written.
    #[error("the checksum does not match: the file was changed or damaged after it was written")]
    Checksum,
    /// A number of the model is NaN or infinite, so that it could not be read again.
    #[error("{path}: {reason}; nothing was written")]
    Unwritable {
        /// Where.
        path: String,
        /// What is wrong there.
        reason: String,
    },
    /// The file cannot be read or written.
    #[error("{0}")]
    File(#[from] io::Error),
}
