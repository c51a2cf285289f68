//! Errors of the Parquet library, as errors of the file.

use std::fmt::Display;

use parquet::errors::ParquetError;

use crate::input::Input;
use crate::{Fault, ReadError};

pub(super) fn failed(error: &ParquetError, input: &Input<'_>) -> ReadError {
    match error {
        ParquetError::NYI(what) => unsupported(what, input),
        ParquetError::General(what) if what.contains("Disabled feature") => unsupported(what, input),
        // The directory stands at the end: a file without it is cut off.
        _ if !input.ends_with(b"PAR1") => {
            ReadError::truncated("the file is cut off: its closing mark is missing", &input.name)
        }
        _ => damaged(error, &input.name),
    }
}

/// How the file contradicts itself, and where.
pub(super) fn damaged(how: impl Display, place: &str) -> ReadError {
    ReadError::corrupt(format!("the file is damaged: {how}"), place)
}

/// The file is fine, but not for us.
fn unsupported(what: &str, input: &Input<'_>) -> ReadError {
    let remedy = "in Python: pq.write_table(pq.read_table(IN), OUT, compression='snappy')";
    ReadError::Unsupported(Fault::new(what, &input.name, remedy))
}
