//! Recordings that are too large to be held together: some files, or pieces of files, are read at once, of each other one a digest is made,
//! here or on another machine.

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
