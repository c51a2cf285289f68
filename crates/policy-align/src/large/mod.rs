//! Recordings that are too large to be held together: some files are read at once, of each other file a digest is made, here or on
//! another machine.

mod digester;
mod division;
mod error;
mod file_digest;
mod part;
mod unfinished;

pub use digester::Digester;
pub use division::{Division, FurtherFile};
pub use error::{DigestError, PartError};
pub use part::Part;
pub use unfinished::Unfinished;
