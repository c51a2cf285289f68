use std::io;

use thiserror::Error;

/// Reasons why a text is not a model, or a model cannot be stored. Paths are those of JSON:
/// `learnt.slope.directions[3]`.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ModelError {
    /// The text begins like JSON but is invalid.
    #[error("damaged or cut off: not JSON ({reason})")]
    NotJson {
        /// The JSON reader's message.
        reason: String,
    },
    /// The text is something else.
    #[error("not a policy-align model: {found}")]
    NotAModel {
        /// Description of the file found instead.
        found: String,
    },
    /// The model was made by a newer program.
    #[error("made by a newer policy-align: model version {found}, this one reads up to {known}")]
    Newer {
        /// The version of the file.
        found: u64,
        /// The newest supported version.
        known: u64,
    },
    /// A member is missing, has another type, or is invalid.
    #[error("{path}: {reason}{}", if *.changed { "; the checksum differs too: the file was changed" } else { "" })]
    Member {
        /// Path of the member.
        path: String,
        /// Description of the fault.
        reason: String,
        /// Whether the checksum is wrong as well.
        changed: bool,
    },
    /// The contents differ from those that were written.
    #[error("the checksum does not match: the file was changed or damaged after it was written")]
    Checksum,
    /// A number of the model is NaN or infinite, and could not be read back.
    #[error("{path}: {reason}; nothing was written")]
    Unwritable {
        /// Path of the number.
        path: String,
        /// Description of the fault.
        reason: String,
    },
    /// The file cannot be read or written.
    #[error("{0}")]
    File(#[from] io::Error),
}
