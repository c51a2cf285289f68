use std::io::Read as _;

use flate2::read::ZlibDecoder;

use super::value::Value;
use crate::arrays::array::Data;
use crate::input::Input;
use crate::{Fault, ReadError};

const COMPRESSED: u32 = 15;
const MATRIX: u32 = 14;
/// The class of an object whose numbers are elsewhere in the file, in an undocumented form of MATLAB. Its name follows its flags,
/// without a size.
const OPAQUE: u32 = 17;

/// Maximum nesting depth of structures.
const DEEPEST: usize = 16;

/// A sequence of data elements: a tag with type and length, then bytes.
pub(super) struct Elements<'a> {
    bytes: &'a [u8],
    big_endian: bool,
    input: &'a Input<'a>,
}

/// Type and bytes of an element.
struct Element<'a> {
    kind: u32,
    bytes: &'a [u8],
}

impl<'a> Elements<'a> {
    pub(super) fn new(bytes: &'a [u8], big_endian: bool, input: &'a Input<'a>) -> Self {
        Self { bytes, big_endian, input }
    }

    /// The next variable of the file, with its name.
    pub(super) fn variable(&mut self) -> Result<Option<(String, Value)>, ReadError> {
        while !self.bytes.is_empty() {
            let element = self.next()?;
            match element.kind {
                COMPRESSED => {
                    let unpacked = self.unpack(element.bytes)?;
                    let inner = Elements { bytes: &unpacked, ..*self }.next()?;
                    if inner.kind == MATRIX {
                        return self.within(inner.bytes).matrix(0).map(Some);
                    }
                }
                MATRIX => return self.within(element.bytes).matrix(0).map(Some),
                _ => {}
            }
        }
        Ok(None)
    }

    fn within<'b>(&self, bytes: &'b [u8]) -> Elements<'b>
    where
        'a: 'b,
    {
        Elements { bytes, big_endian: self.big_endian, input: self.input }
    }

    fn unpack(&self, packed: &[u8]) -> Result<Vec<u8>, ReadError> {
        let most = (packed.len() as u64).saturating_mul(64).saturating_add(1 << 20);
        let most = if self.input.options.trust { u64::MAX } else { most };
        let mut unpacked = Vec::new();
        let read = ZlibDecoder::new(packed).take(most).read_to_end(&mut unpacked);
        let read = read.map_err(|error| self.corrupt(&format!("a variable cannot be decompressed: {error}")))?;
        self.input.charge(read as u64)?;
        if read as u64 == most {
            let what = format!("a variable grows from {} to more than {most} bytes", packed.len());
            return Err(ReadError::grows(what, &self.input.name));
        }
        Ok(unpacked)
    }

    fn corrupt(&self, what: &str) -> ReadError {
        ReadError::Corrupt(Fault::new(what, &self.input.name, "another copy of the file, or save(…, '-v7') again"))
    }

    fn u32_at(&self, at: usize) -> Option<u32> {
        let bytes = self.bytes.get(at..at + 4)?.try_into().ok()?;
        Some(if self.big_endian { u32::from_be_bytes(bytes) } else { u32::from_le_bytes(bytes) })
    }

    /// The next element. A length is accepted only if the file has so many bytes.
    fn next(&mut self) -> Result<Element<'a>, ReadError> {
        let cut = || {
            let what = "the file ends within a variable";
            ReadError::truncated(what, &self.input.name)
        };
        let tag = self.u32_at(0).ok_or_else(cut)?;
        // Up to four bytes are stored in the tag itself.
        let (kind, start, len): (u32, usize, usize) = match tag >> 16 {
            0 => (tag, 8, self.u32_at(4).ok_or_else(cut)? as usize),
            len => (tag & 0xffff, 4, len as usize),
        };
        let bytes = start.checked_add(len).and_then(|end| self.bytes.get(start..end)).ok_or_else(cut)?;
        let end = start + len;
        let padded = if kind == COMPRESSED { end } else { end.next_multiple_of(8) };
        self.bytes = self.bytes.get(padded..).unwrap_or_default();
        Ok(Element { kind, bytes })
    }

    /// Reads a matrix element: flags, dimensions, name, content.
    fn matrix(mut self, depth: usize) -> Result<(String, Value), ReadError> {
        if self.bytes.is_empty() {
            return Ok((String::new(), Value::empty()));
        }
        if depth > DEEPEST {
            return Err(self.corrupt(&format!("structures nest deeper than {DEEPEST}")));
        }
        let flags = self.next()?;
        let flags = self.within(flags.bytes).u32_at(0).ok_or_else(|| self.corrupt("a variable has no type"))?;
        if flags & 0xff == OPAQUE {
            let name = self.name()?;
            return Ok((name, Value::Other("an object of MATLAB, as a table or a string".to_owned())));
        }
        let dimensions = self.next()?;
        let dimensions = self.whole(&dimensions)?;
        let shape: Option<Vec<usize>> = dimensions.iter().map(|&length| usize::try_from(length).ok()).collect();
        let count =
            shape.as_ref().and_then(|shape| shape.iter().try_fold(1usize, |count, &length| count.checked_mul(length)));
        let (Some(shape), Some(count)) = (shape, count) else { return Err(self.corrupt("a variable has no size")) };
        let name = self.name()?;
        let complex = flags & 0x0800 != 0;
        let value = match flags & 0xff {
            1 => Value::Cell(self.matrices(count, depth)?),
            2 => self.structure(count, depth)?,
            3 => {
                self.next()?;
                self.structure(count, depth)?
            }
            4 => Value::Text(self.text()?),
            6..=15 if complex => Value::Other("complex numbers".to_owned()),
            class @ 6..=15 => self.array(shape, count, class)?,
            5 => Value::Other("a sparse matrix".to_owned()),
            _ => Value::Other("an object of MATLAB".to_owned()),
        };
        Ok((name, value))
    }

    fn name(&mut self) -> Result<String, ReadError> {
        Ok(String::from_utf8_lossy(self.next()?.bytes).trim_end_matches('\0').to_owned())
    }

    fn matrices(&mut self, count: usize, depth: usize) -> Result<Vec<Value>, ReadError> {
        let mut values = Vec::new();
        for _ in 0..count {
            let element = self.next()?;
            if element.kind != MATRIX {
                return Err(self.corrupt("an element of a cell array is not a variable"));
            }
            self.input.charge(128)?;
            values.push(self.within(element.bytes).matrix(depth + 1)?.1);
        }
        Ok(values)
    }

    fn structure(&mut self, count: usize, depth: usize) -> Result<Value, ReadError> {
        let length = self.next()?;
        let length =
            self.whole(&length)?.first().copied().and_then(|length| usize::try_from(length).ok()).filter(|&l| l > 0);
        let length = length.ok_or_else(|| self.corrupt("a structure has no fields"))?;
        let names = self.next()?.bytes;
        let name = |bytes: &[u8]| {
            let end = bytes.iter().position(|&byte| byte == 0).unwrap_or(bytes.len());
            String::from_utf8_lossy(&bytes[..end]).into_owned()
        };
        let fields: Vec<String> = names.chunks_exact(length).map(name).collect();
        let all = count.checked_mul(fields.len()).ok_or_else(|| self.corrupt("a structure has no size"))?;
        Ok(Value::Struct { values: self.matrices(all, depth)?, fields })
    }

    fn text(&mut self) -> Result<String, ReadError> {
        let element = self.next()?;
        // UTF-8, or one number per character.
        if matches!(element.kind, 1 | 2 | 16) {
            return Ok(String::from_utf8_lossy(element.bytes).into_owned());
        }
        let codes = self.whole(&element)?;
        let letter = |&code: &i64| u32::try_from(code).ok().and_then(char::from_u32).unwrap_or('\u{fffd}');
        Ok(codes.iter().map(letter).collect())
    }

    fn array(&mut self, shape: Vec<usize>, count: usize, class: u32) -> Result<Value, ReadError> {
        let kinds = ["float64", "float32", "int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64"];
        let kind = kinds[(class - 6) as usize];
        let element = self.next()?;
        // MATLAB stores integers of any class in the smallest type that holds them.
        let data = match (element.kind, class) {
            (7 | 9, _) => Data::Numbers(self.floats(&element)?),
            (_, 6 | 7) => Data::Numbers(self.whole(&element)?.into_iter().map(|value| value as f64).collect()),
            _ => Data::Whole(self.whole(&element)?),
        };
        if data.len() != count {
            return Err(self.corrupt(&format!("a variable has {} numbers where its size needs {count}", data.len())));
        }
        Ok(Value::Numbers { shape, kind, data })
    }

    fn floats(&self, element: &Element<'_>) -> Result<Vec<f64>, ReadError> {
        self.input.charge(element.bytes.len() as u64 * 4)?;
        let double = |bytes: &[u8]| f64::from_bits(self.bits(bytes));
        let single = |bytes: &[u8]| f64::from(f32::from_bits(self.bits(bytes) as u32));
        Ok(match element.kind {
            9 => element.bytes.chunks_exact(8).map(double).collect(),
            _ => element.bytes.chunks_exact(4).map(single).collect(),
        })
    }

    fn bits(&self, bytes: &[u8]) -> u64 {
        let append = |bits: u64, byte: &u8| bits << 8 | u64::from(*byte);
        if self.big_endian { bytes.iter().fold(0, append) } else { bytes.iter().rev().fold(0, append) }
    }

    fn whole(&self, element: &Element<'_>) -> Result<Vec<i64>, ReadError> {
        let (size, signed) = match element.kind {
            1 => (1, true),
            2 | 16 => (1, false),
            3 => (2, true),
            4 | 17 => (2, false),
            5 => (4, true),
            6 | 18 => (4, false),
            12 => (8, true),
            13 => (8, false),
            kind => return Err(self.corrupt(&format!("numbers of type {kind} are not known"))),
        };
        self.input.charge(element.bytes.len() as u64 * 16)?;
        let unused = 64 - 8 * size as u32;
        let value = |bytes: &[u8]| {
            let bits = self.bits(bytes) << unused;
            if signed { bits.cast_signed() >> unused } else { (bits >> unused).cast_signed() }
        };
        Ok(element.bytes.chunks_exact(size).map(value).collect())
    }
}
