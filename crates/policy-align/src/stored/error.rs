use std::io;

use thiserror::Error;

/// Why a text is not a model, or a model cannot be stored. Paths are those of JSON: `learnt.slope.directions[3]`.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ModelError {
    /// The text is not JSON, or stops in the middle.
    #[error("not JSON: {reason}; the file is damaged or was not written to its end, use another copy")]
    NotJson {
        /// What the JSON reader says.
        reason: String,
    },
    /// JSON of something else.
    #[error("not a model of this program: `format` is {found}, not \"policy-align model\"")]
    NotAModel {
        /// What stands there.
        found: String,
    },
    /// Made by a newer program.
    #[error("made by a newer policy-align (model version {found}, this one reads {known}): update")]
    Newer {
        /// The version of the file.
        found: u64,
        /// The newest version that is understood.
        known: u64,
    },
    /// A member is missing, has another type, or cannot be.
    #[error("{path}: {reason}{}", if *.changed { "; the checksum differs too, somebody changed the file" } else { "" })]
    Member {
        /// Where.
        path: String,
        /// What is wrong there.
        reason: String,
        /// Whether the checksum is wrong as well.
        changed: bool,
    },
    /// The checksum does not match the contents.
    #[error("checksum: it is of another text, the file was changed or damaged after it was written; use another copy")]
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
