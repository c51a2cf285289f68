use std::io::{self, Read};

use super::Header;
use crate::arrays::array::Data;

/// Reads `count` values; memory grows only with the bytes that arrive.
pub(super) fn read(header: &Header, count: usize, from: &mut dyn Read) -> io::Result<Data> {
    let (size, big) = (header.size, header.big_endian);
    if matches!(header.letter, 'U' | 'S') {
        let text = |bytes: &[u8]| if header.letter == 'U' { wide_text(bytes, big) } else { narrow_text(bytes) };
        return each(size, count, from, text).map(Data::Text);
    }
    let number = |convert: fn([u8; 8]) -> f64| move |bytes: &[u8]| convert(widened(bytes, big));
    let whole = |convert: fn([u8; 8]) -> i64| move |bytes: &[u8]| convert(widened(bytes, big));
    match (header.letter, size) {
        ('f', 8) => each(size, count, from, number(f64::from_le_bytes)).map(Data::Numbers),
        ('f', 4) => each(size, count, from, number(|b| f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]]))))
            .map(Data::Numbers),
        ('f', 2) => each(size, count, from, number(|b| half(u16::from_le_bytes([b[0], b[1]])))).map(Data::Numbers),
        ('u', 8) => each(size, count, from, number(|b| u64::from_le_bytes(b) as f64)).map(Data::Numbers),
        ('b' | 'u', _) | ('i', 8) => each(size, count, from, whole(i64::from_le_bytes)).map(Data::Whole),
        ('M', 8) => {
            let not_a_time = |dates: Vec<i64>| Data::Dates(dates, header.unit);
            each(size, count, from, whole(i64::from_le_bytes)).map(not_a_time)
        }
        ('i', 1 | 2 | 4) => {
            let unused = 64 - 8 * size as u32;
            each(size, count, from, move |bytes| i64::from_le_bytes(widened(bytes, big)) << unused >> unused)
                .map(Data::Whole)
        }
        _ => Err(io::ErrorKind::InvalidData.into()),
    }
}

/// Converts `count` values of `size` bytes.
fn each<T>(size: usize, count: usize, from: &mut dyn Read, convert: impl Fn(&[u8]) -> T) -> io::Result<Vec<T>> {
    let at_once = ((64 << 10) / size.max(1)).max(1);
    let mut values = Vec::new();
    let mut buffer = vec![0; at_once.min(count) * size];
    while values.len() < count {
        let now = at_once.min(count - values.len());
        from.read_exact(&mut buffer[..now * size])?;
        if size == 0 {
            values.extend((0..now).map(|_| convert(&[])));
        } else {
            values.extend(buffer[..now * size].chunks_exact(size).map(&convert));
        }
    }
    Ok(values)
}

/// Up to eight bytes in little-endian order, padded with zeros.
fn widened(bytes: &[u8], big_endian: bool) -> [u8; 8] {
    let mut wide = [0; 8];
    wide[..bytes.len()].copy_from_slice(bytes);
    if big_endian {
        wide[..bytes.len()].reverse();
    }
    wide
}

/// Converts a half-precision number.
pub(crate) fn half(bits: u16) -> f64 {
    let sign = if bits >> 15 == 1 { -1.0 } else { 1.0 };
    let fraction = f64::from(bits & 0x3ff) / 1024.0;
    sign * match i32::from(bits >> 10 & 0x1f) {
        0 => fraction * 2f64.powi(-14),
        31 if fraction == 0.0 => f64::INFINITY,
        31 => f64::NAN,
        exponent => (1.0 + fraction) * 2f64.powi(exponent - 15),
    }
}

/// Decodes UTF-32, padded with zeros.
fn wide_text(bytes: &[u8], big_endian: bool) -> String {
    let letters = bytes.chunks_exact(4).map(|code| {
        let code = [code[0], code[1], code[2], code[3]];
        if big_endian { u32::from_be_bytes(code) } else { u32::from_le_bytes(code) }
    });
    letters.take_while(|&code| code != 0).map(|code| char::from_u32(code).unwrap_or('\u{fffd}')).collect()
}

fn narrow_text(bytes: &[u8]) -> String {
    let end = bytes.iter().position(|&byte| byte == 0).unwrap_or(bytes.len());
    String::from_utf8_lossy(&bytes[..end]).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_precision_is_exact() {
        for (bits, value) in
            [(0x3c00, 1.0), (0xc000, -2.0), (0x3555, 0.33325195312), (0x0001, 5.960464477539063e-8), (0x7bff, 65504.0)]
        {
            assert!((half(bits) - value).abs() <= 1e-10 * value.abs(), "{bits:x}");
        }
        assert!(half(0x7c00).is_infinite() && half(0x7e00).is_nan());
    }

    #[test]
    fn text_ends_with_its_zeros() {
        assert_eq!(wide_text(&[0, 0, 0, b'x', 0, 0, 0, 0], true), "x");
        assert_eq!(wide_text(&[0xff, 0xff, 0xff, 0xff], false), "\u{fffd}");
        assert_eq!(narrow_text(b"ab\0c"), "ab");
    }
}
