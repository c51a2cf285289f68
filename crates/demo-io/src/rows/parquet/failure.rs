//! What the library's errors mean for whoever has the file.

use std::fmt::Display;

use parquet::errors::ParquetError;

use crate::input::Input;
use crate::{Fault, ReadError};

pub(super) fn failed(error: &ParquetError, input: &Input<'_>) -> ReadError {
    let file = &input.name;
    let copy = "another copy of the file: this one is not whole";
    // The directory stands at the end: a file without it is cut off.
    let ends_well = input.ends_with(b"PAR1");
    match error {
        ParquetError::NYI(what) | ParquetError::General(what) if unsupported(error) => {
            let remedy = "in Python: pq.write_table(pq.read_table(IN), OUT, compression='snappy')";
            ReadError::Unsupported(Fault::new(what.clone(), file, remedy))
        }
        _ if !ends_well => {
            ReadError::Truncated(Fault::new("the file is cut off: its closing mark is missing", file, copy))
        }
        _ => damaged(error, file),
    }
}

/// How the file contradicts itself, and where.
pub(super) fn damaged(how: impl Display, place: &str) -> ReadError {
    ReadError::Corrupt(Fault::new(format!("the file is damaged: {how}"), place, "another copy of the file"))
}

/// Whether the file is fine, but not for us.
fn unsupported(error: &ParquetError) -> bool {
    match error {
        ParquetError::NYI(_) => true,
        ParquetError::General(what) => what.contains("Disabled feature"),
        _ => false,
    }
}
