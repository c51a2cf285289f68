use std::io::Read as _;

use mcap::McapError;
use mcap::records::Record;
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};

use crate::input::{Input, unreadable};
use crate::{Fault, ReadError};

/// How a bag ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum End {
    Whole,
    /// In the middle of a record.
    Cut,
}

/// Read at once.
const BLOCK: usize = 256 << 10;

/// Calls `visit` with the records of a bag, in the order of the file, whatever its index says.
pub(super) fn each(
    input: &Input<'_>,
    progress: &mut dyn FnMut(u64),
    mut visit: impl FnMut(Record<'_>) -> Result<(), ReadError>,
) -> Result<End, ReadError> {
    let longest = input.len.saturating_mul(64).saturating_add(1 << 20).min(1 << 31);
    let options = LinearReaderOptions::default()
        .with_validate_chunk_crcs(true)
        .with_validate_data_section_crc(true)
        .with_record_length_limit(longest as usize);
    let mut reader = LinearReader::new_with_options(options);
    let mut file = input.open()?;
    let mut exhausted = false;
    while let Some(event) = reader.next_event() {
        match event {
            Ok(LinearReadEvent::ReadRequest(wanted)) => {
                // The length asked for may come from a header: no more is taken than a block.
                let block = reader.insert(wanted.clamp(1, BLOCK));
                let read = file.read(block).map_err(|error| unreadable(&error, &input.name))?;
                reader.notify_read(read);
                exhausted = read == 0;
                progress(read as u64);
            }
            Ok(LinearReadEvent::Record { opcode, data }) => {
                input.charge(data.len() as u64)?;
                visit(mcap::parse_record(opcode, data).map_err(|error| damaged(&error, &input.name))?)?;
            }
            Err(McapError::UnexpectedEof) if exhausted => return Ok(End::Cut),
            Err(error) => return Err(damaged(&error, &input.name)),
        }
    }
    Ok(End::Whole)
}

fn damaged(error: &McapError, file: &str) -> ReadError {
    ReadError::Corrupt(Fault::new(
        format!("the bag is damaged: {error}"),
        file,
        "another copy of the file, or mcap recover FILE",
    ))
}
