//! Recordings that are too large to be held in memory together. Some files, or pieces of files, are read at once; each other one is reduced
//! to a digest, here or on another machine.

mod digester;
mod division;
mod error;
mod part;
mod piece_digest;
mod unfinished;

pub use digester::Digester;
pub use division::{Division, FurtherPiece};
pub use error::{DigestError, PartError};
pub use part::Part;
pub use unfinished::Unfinished;
