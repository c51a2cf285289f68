//! Reads recordings of movements from files, with names, units and stamps, and writes them.
//!
//! [`read`] detects the format, the columns of time, movement, state and velocity, and the unit of stamps. [`ReadOptions`]
//! overrides what it detects. A file that cannot be read gives an error of three lines ([`ReadError`]). Lesser problems are
//! [`motion::Finding`]s, and nothing is left out without one. The recorded movements are judged by `prepare`, not here.
//!
//! ```
//! use demo_io::{ReadOptions, read, write};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let folder = tempfile::tempdir()?;
//! # let (table, bag) = (folder.path().join("reach.csv"), folder.path().join("reach.npz"));
//! std::fs::write(&table, "episode,t,x,y\n0,0.0,1.5,2.0\n0,0.1,1.25,2.5\n0,0.2,1.125,2.75\n")?;
//! let recordings = read(&table, &ReadOptions::default(), &mut |_bytes| ())?;
//! assert_eq!(recordings.state[1].name, "y");
//! assert_eq!(recordings.time_step(), 0.1);
//! assert_eq!(recordings.episodes[0].positions.shape(), (2, 3), "samples are columns");
//! write(&bag, &recordings)?;
//!
//! std::fs::write(&table, "t,x\n0.0,1.5\n0.1,\n0.2,1.125\n")?;
//! let error = read(&table, &ReadOptions::default(), &mut |_bytes| ()).unwrap_err();
//! assert_eq!(error.code(), "NotFinite");
//! assert!(error.to_string().contains("line 3"));
//! # Ok(())
//! # }
//! ```
//!
//! | format | feature | what is read |
//! |---|---|---|
//! | CSV, TSV, blanks | | a row a sample; header or column numbers; decimal commas; dates |
//! | NPY, NPZ | | (K, N, n); (M, n) with `episode`, or `episode_ends`; an array a movement |
//! | JSON lines | | a line a movement, or a line a sample |
//! | LeRobot, Parquet | `parquet` | `observation.state`; lists of equal length, or columns |
//! | robomimic, HDF5 | `hdf5` | `/data/demo_0/obs/<key>`, `/mask/<filter>` |
//! | MCAP | `mcap` | JointState, PoseStamped, TwistStamped, Float64MultiArray, JSON |
//! | MAT 5 to 7 | `mat` | cells and arrays of structures, matrices; samples are columns |
//!
//! Files need not be trusted: announced sizes in headers never cause an allocation, and a file takes at most 64 times its
//! size and 64 MB of memory unless [`ReadOptions::trust`] is set.

mod arrays;
mod clean;
mod error;
mod guard;
mod input;
mod joined;
mod label_entry;
mod names;
mod options;
mod raw;
mod read;
mod regular_file;
mod resample;
mod rows;
mod sniff;
mod whole_file;
mod write;

pub use error::{Fault, ReadError};
pub use guard::catches_panics;
pub use motion::TimeUnit;
pub use options::{Format, Nan, ReadOptions, SamplesAre};
pub use read::{files_of, pieces_of, read, read_all, read_further, read_pieces, read_with_context};
pub use regular_file::{FileState, read_bounded, read_bytes, read_text};
pub use resample::{ResampleError, resampled};
pub use rows::piece::{Piece, Span, bytes_of};
pub use whole_file::{Sink, TempFile, abandon_drafts, write_whole};
pub use write::{LinkFrames, WriteError, write, write_with_robot};

/// The program of the README, compiled.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
