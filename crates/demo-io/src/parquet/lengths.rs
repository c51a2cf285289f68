//! Lengths of lists in a file's own descriptions, before the library believes them: it counts a list of two thousand million
//! truth values through, though the file has no byte for them.
//!
//! Descriptions are in Thrift's compact protocol: fields of a kind each, up to a kind 0.

use parquet::file::metadata::ColumnChunkMetaData;

use crate::input::Input;
use crate::{Fault, ReadError};

/// Bytes at the end: length of the closing description, and the mark.
const END: u64 = 8;
/// Room for a page's description; what is longer is left to the library.
const PAGE: u64 = 64 << 10;
/// Descriptions in descriptions; the library follows as many.
const DEPTH: usize = 64;

/// Why a description cannot be followed further.
enum Stop {
    /// It ends, or is none: the library says what is wrong with it.
    Unreadable,
    /// A list has more elements than there are bytes.
    Overlong,
}

/// Refuses a closing description with a list that is longer than itself.
pub(super) fn check_end(input: &Input<'_>) -> Result<(), ReadError> {
    let Some(start) = input.len.checked_sub(END) else { return Ok(()) };
    let mut file = input.open()?;
    let Some(&[a, b, c, d]) = input.part(&mut file, start, 4)?.first_chunk() else { return Ok(()) };
    let length = u64::from(u32::from_le_bytes([a, b, c, d]));
    let Some(start) = start.checked_sub(length) else { return Ok(()) };
    let text = input.part(&mut file, start, length)?;
    refuse(&Description { left: &text, page_size: None }.structure(DEPTH), input).map(|_| ())
}

/// The same of the pages of a column in a group of rows.
pub(super) fn check_pages(chunk: &ColumnChunkMetaData, input: &Input<'_>) -> Result<(), ReadError> {
    let mut file = input.open()?;
    let (mut at, size) = chunk.byte_range();
    let end = at.saturating_add(size).min(input.len);
    while at < end {
        let text = input.part(&mut file, at, PAGE.min(end - at))?;
        let mut description = Description { left: &text, page_size: None };
        let whole = refuse(&description.structure(DEPTH), input)?;
        let taken = (text.len() - description.left.len()) as u64;
        let Some(page) = description.page_size.filter(|_| whole) else { return Ok(()) };
        at = at.saturating_add(taken).saturating_add(page);
    }
    Ok(())
}

/// Whether a description was followed to its end.
fn refuse(outcome: &Result<(), Stop>, input: &Input<'_>) -> Result<bool, ReadError> {
    match outcome {
        Ok(()) => Ok(true),
        Err(Stop::Unreadable) => Ok(false),
        Err(Stop::Overlong) => {
            let what = "the file is damaged: it describes a list longer than itself";
            Err(ReadError::Corrupt(Fault::new(what, &input.name, "another copy of the file")))
        }
    }
}

struct Description<'a> {
    left: &'a [u8],
    /// Field 3 of the outermost structure: of a page, its bytes after the description.
    page_size: Option<u64>,
}

impl Description<'_> {
    fn structure(&mut self, depth: usize) -> Result<(), Stop> {
        let mut field = 0;
        loop {
            let head = self.byte()?;
            let kind = head & 15;
            if kind == 0 {
                return Ok(());
            }
            let step = i64::from(head >> 4);
            field = if step == 0 { zigzag(self.number()?) } else { field + step };
            if (depth, field, kind) == (DEPTH, 3, 5) {
                self.page_size = u64::try_from(zigzag(self.number()?)).ok();
            } else if !matches!(kind, 1 | 2) {
                self.value(kind, depth)?; // a truth value is its kind
            }
        }
    }

    fn value(&mut self, kind: u8, depth: usize) -> Result<(), Stop> {
        let depth = depth.checked_sub(1).ok_or(Stop::Unreadable)?;
        match kind {
            1..=3 => self.skip(1),
            4..=6 => self.number().map(|_| ()),
            7 => self.skip(8),
            8 => {
                let length = self.number()?;
                self.skip(length)
            }
            9 | 10 => {
                let head = self.byte()?;
                let length = if head >> 4 == 15 { self.number()? } else { u64::from(head >> 4) };
                self.elements(length, &[head & 15], depth)
            }
            11 => match self.number()? {
                0 => Ok(()),
                length => {
                    let kinds = self.byte()?;
                    self.elements(length, &[kinds >> 4, kinds & 15], depth)
                }
            },
            12 => self.structure(depth),
            13 => self.skip(16),
            _ => Err(Stop::Unreadable),
        }
    }

    fn elements(&mut self, length: u64, kinds: &[u8], depth: usize) -> Result<(), Stop> {
        if length > self.left.len() as u64 {
            return Err(Stop::Overlong);
        }
        for _ in 0..length {
            for &kind in kinds {
                self.value(kind, depth)?;
            }
        }
        Ok(())
    }

    fn byte(&mut self) -> Result<u8, Stop> {
        let (&first, left) = self.left.split_first().ok_or(Stop::Unreadable)?;
        self.left = left;
        Ok(first)
    }

    fn skip(&mut self, length: u64) -> Result<(), Stop> {
        let length = usize::try_from(length).map_err(|_| Stop::Unreadable)?;
        self.left = self.left.get(length..).ok_or(Stop::Unreadable)?;
        Ok(())
    }

    /// Seven bits a byte, the last one below 128.
    fn number(&mut self) -> Result<u64, Stop> {
        let mut number = 0;
        for shift in (0..64).step_by(7) {
            let byte = self.byte()?;
            number |= u64::from(byte & 127) << shift;
            if byte < 128 {
                return Ok(number);
            }
        }
        Err(Stop::Unreadable)
    }
}

fn zigzag(number: u64) -> i64 {
    (number >> 1).cast_signed() ^ -((number & 1).cast_signed())
}
