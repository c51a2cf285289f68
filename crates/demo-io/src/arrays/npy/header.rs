use std::io::Read;

use super::MAGIC;
use crate::{Fault, ReadError, TimeUnit};

/// The header of a .npy file, which describes its array.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Header {
    /// Type code: 'f', 'i', 'U'.
    pub(crate) letter: char,
    /// Bytes of one value.
    pub(crate) size: usize,
    pub(super) big_endian: bool,
    /// The unit of dates.
    pub(super) unit: TimeUnit,
    pub(super) fortran: bool,
    pub(crate) shape: Vec<usize>,
    /// Bytes before the numbers.
    pub(crate) len: u64,
}

/// Records with very many fields reach 64 kB. A longer text is no header.
const LONGEST: u32 = 1 << 20;

impl Header {
    pub(crate) fn read(from: &mut dyn Read, file: &str) -> Result<Self, ReadError> {
        let cut = |_| ReadError::truncated("the file ends within the header of an array", file);
        let mut start = [0; 8];
        from.read_exact(&mut start).map_err(cut)?;
        if !start.starts_with(MAGIC) {
            let what = "not a NumPy array: it does not begin with \\x93NUMPY";
            return Err(ReadError::NotThisFormat(Fault::new(what, file, "numpy.save or numpy.savez to write it")));
        }
        let wide = start[6] >= 2;
        let mut length = [0; 4];
        from.read_exact(if wide { &mut length } else { &mut length[..2] }).map_err(cut)?;
        let length = u32::from_le_bytes(length);
        if length > LONGEST {
            let what = format!("the header of an array is {length} bytes long");
            return Err(ReadError::corrupt(what, file));
        }
        let mut text = vec![0; length as usize];
        from.read_exact(&mut text).map_err(cut)?;
        let len = if wide { 12 } else { 10 } + u64::from(length);
        Self::parse(&String::from_utf8_lossy(&text), len).ok_or_else(|| {
            let what = "the header of an array cannot be understood";
            ReadError::Corrupt(Fault::new(what, file, "numpy.save or numpy.savez to write it again"))
        })
    }

    /// Parses `{'descr': '<f8', 'fortran_order': False, 'shape': (40, 40, 2), }`.
    fn parse(text: &str, len: u64) -> Option<Self> {
        let descr = value_of(text, "descr")?;
        let fortran = value_of(text, "fortran_order")?.starts_with("True");
        let shape = value_of(text, "shape")?.strip_prefix('(')?;
        let shape = shape[..shape.find(')')?].split(',').map(str::trim).filter(|length| !length.is_empty());
        // Python 2 wrote long integers as 40L.
        let shape = shape.map(|length| length.trim_end_matches('L').parse().ok()).collect::<Option<Vec<_>>>()?;
        let (big_endian, letter, size, unit) = match descr.strip_prefix(['\'', '"']) {
            Some(descr) => value_type(&descr[..descr.find(['\'', '"'])?])?,
            // A list of fields.
            None => (false, 'V', 1, TimeUnit::Seconds),
        };
        Some(Self { letter, size, big_endian, unit, fortran, shape, len })
    }
}

/// The text that follows `'key':`.
fn value_of<'a>(text: &'a str, key: &str) -> Option<&'a str> {
    let at = text.find(&format!("'{key}'")).or_else(|| text.find(&format!("\"{key}\"")))?;
    text[at + key.len() + 2..].trim_start().strip_prefix(':').map(str::trim_start)
}

/// Byte order, letter, size and unit of `<f8`, `|b1`, `>M8[ns]`, `<U12`.
fn value_type(descr: &str) -> Option<(bool, char, usize, TimeUnit)> {
    let (order, rest) = match descr.chars().next()? {
        order @ ('<' | '>' | '|' | '=') => (order, &descr[1..]),
        _ => ('=', descr),
    };
    let letter = rest.chars().next()?;
    let (size, unit) = rest[letter.len_utf8()..].split_once('[').unwrap_or((&rest[letter.len_utf8()..], ""));
    let size: usize = if size.is_empty() { 1 } else { size.parse().ok()? };
    let size = if letter == 'U' { size.checked_mul(4)? } else { size };
    let unit = TimeUnit::of(unit.trim_end_matches(']')).unwrap_or(TimeUnit::Seconds);
    Some((order == '>', letter, size, unit))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> Option<Header> {
        Header::parse(text, 0)
    }

    #[test]
    fn headers_of_all_versions_of_numpy_are_understood() {
        let header = parsed("{'descr': '>f4', 'fortran_order': True, 'shape': (40, 2), }   \n").unwrap();
        assert_eq!((header.letter, header.size, header.big_endian, header.fortran), ('f', 4, true, true));
        assert_eq!(header.shape, [40, 2]);
        let scalar = parsed("{'descr': '<U5', 'fortran_order': False, 'shape': ()}").unwrap();
        assert_eq!((scalar.letter, scalar.size, scalar.shape.len()), ('U', 20, 0));
        assert_eq!(parsed("{\"shape\":(3L,), \"fortran_order\":False, \"descr\":\"|b1\"}").unwrap().shape, [3]);
        assert_eq!(parsed("{'descr': [('x', '<f8')], 'fortran_order': False, 'shape': (3,)}").unwrap().letter, 'V');
        assert_eq!(
            parsed("{'descr': '<M8[us]', 'fortran_order': False, 'shape': (3,)}").unwrap().unit,
            TimeUnit::Microseconds
        );
    }

    #[test]
    fn nonsense_is_refused() {
        for text in [
            "",
            "{'descr': '<f8'}",
            "{'descr': '<', 'fortran_order': False, 'shape': ()}",
            "{'descr': '<fé', 'fortran_order': 0, 'shape': (1)}",
        ] {
            assert_eq!(parsed(text), None, "{text}");
        }
        assert_eq!(parsed("{'descr': '<f8', 'fortran_order': False, 'shape': (-1, 2)}"), None);
    }
}
