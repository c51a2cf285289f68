//! Recordings of movements: what a file says, with names, units and stamps, before anybody decides what to make of it.

mod array;
#[cfg(feature = "mcap")]
mod cdr;
mod clean;
mod delimited;
mod documents;
mod draft;
mod error;
mod fields;
mod flat;
mod grouped;
#[cfg(feature = "hdf5")]
mod hdf5;
mod input;
mod json;
mod json_lines;
mod layout;
#[cfg(feature = "parquet")]
mod lerobot;
#[cfg(feature = "mat")]
mod mat;
#[cfg(feature = "mcap")]
mod mcap;
mod natural;
mod note;
mod notice;
mod npy;
mod npz;
mod options;
#[cfg(feature = "parquet")]
mod parquet;
mod read;
mod recordings;
mod roles;
mod selection;
mod sniff;
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
