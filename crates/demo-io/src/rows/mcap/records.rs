use std::io::{self, BufReader, Read};

use thiserror::Error;

use super::format::{MAGIC, opcode};
use super::record::Record;
use super::source::{ChecksumReader, ProgressReader, content, head, skip};
use crate::input::{Input, unreadable};
use crate::rows::packed::{self, Misfit};
use crate::{Fault, ReadError};

/// Calls `visit` with the records of a bag in the order of the file, without using its index. Returns false if the bag ends in
/// the middle of a record.
///
/// Records are decompressed one after another, so that a bag need not fit into memory, and the file of a killed recorder can be
/// read.
pub(super) fn each(
    input: &Input<'_>,
    progress: &mut dyn FnMut(u64),
    mut visit: impl FnMut(Record<'_>) -> Result<(), ReadError>,
) -> Result<bool, ReadError> {
    let mut file = ChecksumReader::new(ProgressReader::new(input.open()?, progress));
    let mut reader = Reader { input, visit: &mut visit, buffer: Vec::new() };
    match reader.bag(&mut file) {
        Ok(()) => Ok(true),
        Err(Stop::Refused(error)) => Err(error),
        Err(Stop::Bytes(error)) if error.raw_os_error().is_some() => Err(unreadable(&error, &input.name)),
        // The missing bytes would be behind the end of the file.
        Err(Stop::Bytes(_)) if file.ended => Ok(false),
        Err(stop) => {
            let remedy = "another copy of the file, or mcap recover FILE";
            Err(ReadError::Corrupt(Fault::new(format!("the bag is damaged: {stop}"), &input.name, remedy)))
        }
    }
}

/// The reason why reading ends early.
#[derive(Debug, Error)]
enum Stop {
    /// Bytes that cannot be read from the file or decompressed.
    #[error("what was packed cannot be unpacked ({0})")]
    Bytes(#[from] io::Error),
    #[error("{0}")]
    Damaged(String),
    #[error(transparent)]
    Misfit(#[from] Misfit),
    #[error(transparent)]
    Refused(#[from] ReadError),
}

struct Reader<'a, 'v> {
    input: &'a Input<'a>,
    visit: &'v mut dyn FnMut(Record<'_>) -> Result<(), ReadError>,
    /// Contents of a record.
    buffer: Vec<u8>,
}

impl Reader<'_, '_> {
    fn bag<R: Read>(&mut self, file: &mut ChecksumReader<R>) -> Result<(), Stop> {
        magic(file, "begin")?;
        loop {
            let sum = file.sum();
            let (kind, length) = head(file)?.ok_or_else(|| io::Error::from(io::ErrorKind::UnexpectedEof))?;
            match kind {
                opcode::CHUNK => self.chunk(file, length)?,
                opcode::DATA_END => {
                    let stated = packed::Reader::of_record(content(file, length, &mut self.buffer)?).u32()?;
                    agree(stated, sum, "the data")?;
                }
                opcode::FOOTER => {
                    skip(file, length)?;
                    return magic(file, "end");
                }
                _ => self.record(kind, length, file)?,
            }
        }
    }

    /// Handles a record outside or inside a chunk.
    fn record(&mut self, kind: u8, length: u64, source: &mut impl Read) -> Result<(), Stop> {
        if kind == 0 {
            return Err(Stop::Damaged("there is a record of kind 0".to_owned()));
        }
        if !Record::is_read(kind) {
            return Ok(skip(source, length)?);
        }
        let record = Record::parse(kind, content(source, length, &mut self.buffer)?)?;
        Ok((self.visit)(record)?)
    }

    fn chunk<R: Read>(&mut self, file: &mut ChecksumReader<R>, length: u64) -> Result<(), Stop> {
        let mut packed = file.take(length);
        let mut fixed = [0; 32];
        packed.read_exact(&mut fixed)?;
        let mut fields = packed::Reader::of_record(&fixed[16..]);
        let (unpacked, stated, name) = (fields.u64()?, fields.u32()?, fields.u32()?);
        let compression =
            String::from_utf8_lossy(content(&mut packed, u64::from(name), &mut self.buffer)?).into_owned();
        let mut rest = [0; 8];
        packed.read_exact(&mut rest)?;
        if u64::from_le_bytes(rest) > packed.limit() {
            return Err(Stop::Damaged("a chunk is longer than its record".to_owned()));
        }
        self.input.charge(unpacked)?;
        let unpacking: Box<dyn Read + '_> = match &compression[..] {
            "" => Box::new(&mut packed),
            "lz4" => Box::new(lz4_flex::frame::FrameDecoder::new(&mut packed)),
            "zstd" => {
                let mut decoder = zstd::stream::read::Decoder::new(&mut packed)?;
                decoder.window_log_max(self.largest_window())?;
                Box::new(BufReader::new(decoder))
            }
            other => {
                let what = format!("a chunk is compressed with {other:?}, which is neither lz4 nor zstd");
                return Err(Stop::Damaged(what));
            }
        };
        let mut records = ChecksumReader::new(unpacking).take(unpacked);
        while let Some((kind, length)) = head(&mut records)? {
            if length > records.limit() {
                return Err(Stop::Damaged("a record is longer than its chunk".to_owned()));
            }
            self.record(kind, length, &mut records)?;
        }
        if records.limit() > 0 {
            return Err(Stop::Bytes(io::ErrorKind::UnexpectedEof.into()));
        }
        agree(stated, records.get_ref().sum(), "a chunk")?;
        drop(records);
        let behind = packed.limit();
        Ok(skip(&mut packed, behind)?)
    }

    /// Largest window of a compressed chunk, as a power of two. A chunk may request this much memory before its first byte is
    /// decompressed.
    fn largest_window(&self) -> u32 {
        if self.input.len < 1 << 20 { 26 } else { 27 }
    }
}

fn magic(file: &mut impl Read, which: &str) -> Result<(), Stop> {
    let mut found = [0; MAGIC.len()];
    file.read_exact(&mut found)?;
    if found == MAGIC { Ok(()) } else { Err(Stop::Damaged(format!("it does not {which} as bags do"))) }
}

/// Compares checksums. A stated sum of 0 means that none was computed.
fn agree(stated: u32, sum: u32, what: &str) -> Result<(), Stop> {
    if stated == 0 || stated == sum {
        Ok(())
    } else {
        Err(Stop::Damaged(format!("{what} does not have its check sum")))
    }
}
