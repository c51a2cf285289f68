//! Recordings that are too large to be held together: some files are read at once, of each other file a digest is made, here or on
//! another machine.

mod division;
mod error;
mod file_digest;
mod part;

pub use division::{Division, FurtherFile};
pub use error::PartError;
pub use file_digest::digest_file;
pub use part::Part;
