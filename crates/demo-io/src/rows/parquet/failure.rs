//! Converts errors of the Parquet library to errors of the file.

use std::fmt::Display;

use parquet::errors::ParquetError;

use crate::input::Input;
use crate::{Fault, ReadError};

pub(super) fn failed(error: &ParquetError, input: &Input<'_>) -> ReadError {
    match error {
        ParquetError::NYI(what) => unsupported(what, input),
        ParquetError::General(what) if what.contains("Disabled feature") => unsupported(what, input),
        // The directory is at the end, so that a file without it is truncated.
        _ if !input.ends_with(b"PAR1") => {
            ReadError::truncated("the file is cut off: its closing mark is missing", &input.name)
        }
        _ => damaged(error, &input.name),
    }
}

/// Error: states how the file contradicts itself, and where.
pub(super) fn damaged(how: impl Display, place: &str) -> ReadError {
    ReadError::corrupt(format!("the file is damaged: {how}"), place)
}

/// Error: the file is valid but not supported.
fn unsupported(what: &str, input: &Input<'_>) -> ReadError {
    let remedy = "in Python: pq.write_table(pq.read_table(IN), OUT, compression='snappy')";
    ReadError::Unsupported(Fault::new(what, &input.name, remedy))
}
