//! Checks a file's metadata before the library reads it. The library reads a field as the type that the format prescribes
//! even if the file states another, and iterates over a list of two thousand million booleans though the file has no byte
//! for them.
//!
//! The metadata use Thrift's compact protocol: fields, each with a kind, up to a kind 0.

use parquet::file::metadata::ColumnChunkMetaData;

use super::failure::damaged;
use super::fields::{FILE, Fields, Holds, PAGE};
use crate::ReadError;
use crate::input::Input;

/// Bytes at the end of the file: the length of the footer metadata, and the magic number.
const END: u64 = 8;
/// Maximum size of a page header; longer ones are left to the library.
const ROOM: u64 = 64 << 10;
/// Maximum nesting depth; the library follows as many levels.
const DEPTH: usize = 64;

/// The reason why parsing stops.
enum Stop {
    /// The description ends or is invalid; the library reports the error.
    Unreadable,
    /// A list has more elements than there are bytes.
    Overlong,
    /// A field has a type other than the format prescribes.
    Other,
}

/// Refuses footer metadata that the library would misread.
pub(super) fn check_end(input: &Input<'_>) -> Result<(), ReadError> {
    let Some(start) = input.len.checked_sub(END) else { return Ok(()) };
    let mut file = input.open()?;
    let Some(&[a, b, c, d]) = input.part(&mut file, start, 4)?.first_chunk() else { return Ok(()) };
    let length = u64::from(u32::from_le_bytes([a, b, c, d]));
    let Some(start) = start.checked_sub(length) else { return Ok(()) };
    let text = input.part(&mut file, start, length)?;
    refuse(&Description { left: &text, sizes: [None; 3] }.structure(FILE, DEPTH), input).map(|_| ())
}

/// The same for the pages of a column in a row group. At the end of the file the library does not notice that skipped bytes
/// do not exist, and continues to skip.
pub(super) fn check_pages(chunk: &ColumnChunkMetaData, input: &Input<'_>) -> Result<(), ReadError> {
    let mut file = input.open()?;
    let (mut at, size) = chunk.byte_range();
    let end = at.saturating_add(size).min(input.len);
    while at < end {
        let room = ROOM.min(input.len - at);
        let text = input.part(&mut file, at, room)?;
        let mut description = Description { left: &text, sizes: [None; 3] };
        let whole = refuse(&description.structure(PAGE, DEPTH), input)?;
        if !whole && at + room == input.len {
            return Err(damaged("it ends within the description of a page", &input.name));
        }
        let [page, in_file, values] = description.sizes;
        if values.zip(page).is_some_and(|(values, page)| values > page) {
            return Err(damaged("a dictionary has more values than bytes", &input.name));
        }
        let taken = (text.len() - description.left.len()) as u64;
        let Some(in_file) = in_file.filter(|_| whole) else { return Ok(()) };
        at = at.saturating_add(taken).saturating_add(in_file);
    }
    Ok(())
}

/// Whether a description was parsed to its end.
fn refuse(outcome: &Result<(), Stop>, input: &Input<'_>) -> Result<bool, ReadError> {
    match outcome {
        Ok(()) => Ok(true),
        Err(Stop::Unreadable) => Ok(false),
        Err(Stop::Overlong) => Err(damaged("it describes a list longer than itself", &input.name)),
        Err(Stop::Other) => {
            Err(damaged("a field of its description holds something else than the format says", &input.name))
        }
    }
}

const BYTE: u8 = 3;
const DOUBLE: u8 = 7;
const BYTES: u8 = 8;
const STRUCTURE: u8 = 12;

impl Holds {
    fn is(&self, kind: u8) -> bool {
        match self {
            Holds::Any => true,
            Holds::Truth => matches!(kind, 1 | 2),
            Holds::Byte => kind == BYTE,
            Holds::Integer | Holds::Size(_) => (4..=6).contains(&kind),
            Holds::Double => kind == DOUBLE,
            Holds::Bytes => kind == BYTES,
            Holds::List(_) => matches!(kind, 9 | 10),
            Holds::Fields(_) => kind == STRUCTURE,
        }
    }
}

struct Description<'a> {
    left: &'a [u8],
    /// Indexed by `Size`.
    sizes: [Option<u64>; 3],
}

impl Description<'_> {
    fn structure(&mut self, fields: &Fields, depth: usize) -> Result<(), Stop> {
        let depth = depth.checked_sub(1).ok_or(Stop::Unreadable)?;
        let mut number = 0_i16;
        loop {
            let head = self.byte()?;
            let kind = head & 15;
            if kind == 0 {
                return Ok(());
            }
            // As in the library: an explicit number is truncated to two bytes.
            number = match i16::from(head >> 4) {
                0 => zigzag(self.integer()?) as i16,
                step => number.checked_add(step).ok_or(Stop::Unreadable)?,
            };
            let holds = usize::try_from(number).ok().and_then(|number| fields.get(number.checked_sub(1)?));
            if holds.is_some_and(|holds| !holds.is(kind)) {
                return Err(Stop::Other);
            }
            self.value(kind, holds, depth)?;
        }
    }

    /// Skips the value that follows the kind. A boolean has none, because its kind is its value.
    fn value(&mut self, kind: u8, holds: Option<&Holds>, depth: usize) -> Result<(), Stop> {
        match kind {
            1 | 2 => Ok(()),
            BYTE => self.skip(1),
            4..=6 => {
                let integer = zigzag(self.integer()?) as i32;
                if let Some(Holds::Size(size)) = holds {
                    self.sizes[*size as usize] = u64::try_from(integer).ok();
                }
                Ok(())
            }
            DOUBLE => self.skip(8),
            BYTES => {
                let length = self.integer()?;
                self.skip(length)
            }
            9 | 10 => {
                let head = self.byte()?;
                let length = if head >> 4 == 15 { self.integer()? } else { u64::from(head >> 4) };
                let element = if let Some(Holds::List(element)) = holds { Some(*element) } else { None };
                self.elements(length, &[(head & 15, element)], depth)
            }
            11 => match self.integer()? {
                0 => Ok(()),
                length => {
                    let kinds = self.byte()?;
                    self.elements(length, &[(kinds >> 4, None), (kinds & 15, None)], depth)
                }
            },
            STRUCTURE => {
                let fields = if let Some(Holds::Fields(fields)) = holds { *fields } else { &[] };
                self.structure(fields, depth)
            }
            13 => self.skip(16),
            _ => Err(Stop::Unreadable),
        }
    }

    /// Skips the elements of a list, or the alternating keys and values of a map.
    fn elements(&mut self, length: u64, kinds: &[(u8, Option<&Holds>)], depth: usize) -> Result<(), Stop> {
        let depth = depth.checked_sub(1).ok_or(Stop::Unreadable)?;
        if length > self.left.len() as u64 {
            return Err(Stop::Overlong);
        }
        if length > 0 && kinds.iter().any(|(kind, holds)| holds.is_some_and(|holds| !holds.is(*kind))) {
            return Err(Stop::Other);
        }
        for _ in 0..length {
            for &(kind, holds) in kinds {
                self.value(kind, holds, depth)?;
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

    /// Reads an integer with seven bits per byte; its last byte is below 128.
    fn integer(&mut self) -> Result<u64, Stop> {
        let mut integer = 0;
        for shift in (0..64).step_by(7) {
            let byte = self.byte()?;
            integer |= u64::from(byte & 127) << shift;
            if byte < 128 {
                return Ok(integer);
            }
        }
        Err(Stop::Unreadable)
    }
}

fn zigzag(integer: u64) -> i64 {
    (integer >> 1).cast_signed() ^ -((integer & 1).cast_signed())
}
