//! One NumPy array: `\x93NUMPY`, a version, a Python dictionary, and the numbers.

mod header;
mod values;

use std::io::Read;

pub(crate) use self::header::Header;
#[cfg(any(feature = "hdf5", feature = "parquet"))]
pub(crate) use self::values::half;
use crate::ReadError;
use crate::arrays::array::{ArraySpec, Data, Kind};
use crate::arrays::flat;
use crate::input::Input;
use crate::raw::RawRecordings;

pub(crate) const MAGIC: &[u8] = b"\x93NUMPY";

/// Reads a file with one array, which must be the state.
pub(crate) fn read(input: &Input<'_>, progress: &mut dyn FnMut(u64)) -> Result<RawRecordings, ReadError> {
    let mut file = std::io::BufReader::new(input.open()?);
    let header = Header::read(&mut file, &input.name)?;
    let described = [header.described("state".to_owned())];
    let left = input.len.saturating_sub(header.len);
    flat::recordings(input, &described, &mut |_| {
        progress(input.len);
        header.data(&mut file, left, &input.name, input)
    })
}

impl Header {
    pub(crate) fn described(&self, name: String) -> ArraySpec {
        ArraySpec { name, shape: self.shape.clone(), kind: self.kind() }
    }

    fn kind(&self) -> Kind {
        let (letter, size) = (self.letter, self.size);
        match (letter, size) {
            ('f', 2) => Kind::Number("float16"),
            ('f', 4) => Kind::Number("float32"),
            ('f', 8) => Kind::Number("float64"),
            ('i', 1) => Kind::Number("int8"),
            ('i', 2) => Kind::Number("int16"),
            ('i', 4) => Kind::Number("int32"),
            ('i', 8) => Kind::Number("int64"),
            ('u', 1) => Kind::Number("uint8"),
            ('u', 2) => Kind::Number("uint16"),
            ('u', 4) => Kind::Number("uint32"),
            ('u', 8) => Kind::Number("uint64"),
            ('b', 1) => Kind::Number("bool"),
            ('M', 8) => Kind::Number("datetime64"),
            ('U' | 'S', _) => Kind::Text,
            ('O', _) => Kind::Pickled,
            ('c', _) => Kind::Other(format!("complex{}", size.saturating_mul(8))),
            ('f', _) => Kind::Other(format!("float{} (long double)", size.saturating_mul(8))),
            ('V', _) => Kind::Other("records with named fields".to_owned()),
            _ => Kind::Other(format!("'{letter}{size}'")),
        }
    }

    /// Reads the numbers from a source of at most `bytes` bytes.
    pub(crate) fn data(
        &self,
        from: &mut dyn Read,
        bytes: u64,
        file: &str,
        input: &Input<'_>,
    ) -> Result<Data, ReadError> {
        let shape = || crate::arrays::array::shape_text(&self.shape);
        let count = self.shape.iter().try_fold(1usize, |count, &length| count.checked_mul(length));
        let needed = count.and_then(|count| count.checked_mul(self.size)).filter(|&needed| needed as u64 <= bytes);
        let (Some(count), Some(_)) = (count, needed) else { return Err(truncated(&shape(), file)) };
        input.charge(count.saturating_mul(self.size.max(8)) as u64)?;
        let data = values::read(self, count, from).map_err(|error| match error.kind() {
            std::io::ErrorKind::UnexpectedEof => truncated(&shape(), file),
            _ => crate::input::damaged(&error, file),
        })?;
        Ok(if self.fortran && self.shape.len() > 1 { data.in_c_order(&self.shape) } else { data })
    }
}

fn truncated(shape: &str, file: &str) -> ReadError {
    let what = format!("the file ends before the array of shape ({shape}) that it announces");
    ReadError::truncated(what, file)
}
