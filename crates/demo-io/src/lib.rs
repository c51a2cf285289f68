//! Recordings of movements: what a file says, with names, units and stamps, before anybody decides what to make of it.

mod clean;
mod delimited;
mod draft;
mod error;
mod input;
mod note;
mod notice;
mod options;
mod read;
mod recordings;
mod roles;
mod selection;
mod stamps;
mod statistics;
mod table;
mod write;

pub use error::{Fault, ReadError};
pub use note::{Note, NoteKind};
pub use options::{Format, Nan, ReadOptions, SamplesAre};
pub use read::{read, read_all};
pub use recordings::{Channel, Episode, Recordings, Source};
pub use write::{WriteError, write};
