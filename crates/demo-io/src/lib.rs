//! Recordings of movements: what a file says, with names, units and stamps, before anybody decides what to make of it.

mod note;
mod recordings;

pub use note::{Note, NoteKind};
pub use recordings::{Channel, Episode, Recordings, Source};
