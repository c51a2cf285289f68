//! Values packed in bytes: ROS 2 messages, in Common Data Representation, and the records of a bag.

use std::collections::BTreeMap;

use thiserror::Error;

/// Reads values one after another.
pub(crate) struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
    big_endian: bool,
    /// Largest alignment of a value; smaller values are aligned to their size.
    widest: usize,
}

/// The bytes end early, or a text is not valid.
#[derive(Debug, PartialEq, Eq, Error)]
#[error("a record does not hold what its kind asks for")]
pub(crate) struct Misfit;

impl<'a> Reader<'a> {
    /// Reads a record of a bag: little-endian, without alignment.
    pub(crate) fn of_record(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0, big_endian: false, widest: 1 }
    }

    /// Reads a ROS 2 message. Its first four bytes state the byte order and the version; version 2 aligns to at most 4
    /// bytes.
    pub(crate) fn of_message(message: &'a [u8]) -> Result<Self, Misfit> {
        let (head, bytes) = message.split_at_checked(4).ok_or(Misfit)?;
        Ok(Self { bytes, at: 0, big_endian: head[1] % 2 == 0, widest: if head[1] >= 6 { 4 } else { 8 } })
    }

    fn take<const N: usize>(&mut self) -> Result<[u8; N], Misfit> {
        let start = self.at.next_multiple_of(N.min(self.widest));
        let bytes = self.bytes.get(start..start + N).ok_or(Misfit)?;
        self.at = start + N;
        let mut value = [0; N];
        value.copy_from_slice(bytes);
        if self.big_endian {
            value.reverse();
        }
        Ok(value)
    }

    pub(crate) fn u16(&mut self) -> Result<u16, Misfit> {
        Ok(u16::from_le_bytes(self.take()?))
    }

    pub(crate) fn u64(&mut self) -> Result<u64, Misfit> {
        Ok(u64::from_le_bytes(self.take()?))
    }

    pub(crate) fn u32(&mut self) -> Result<u32, Misfit> {
        Ok(u32::from_le_bytes(self.take()?))
    }

    pub(crate) fn i32(&mut self) -> Result<i32, Misfit> {
        Ok(i32::from_le_bytes(self.take()?))
    }

    pub(crate) fn f64(&mut self) -> Result<f64, Misfit> {
        Ok(f64::from_le_bytes(self.take()?))
    }

    /// Reads a number of elements of at least `size` bytes, and checks that the bytes exist.
    fn count(&mut self, size: usize) -> Result<usize, Misfit> {
        let count = self.u32()? as usize;
        let there = self.bytes.len().saturating_sub(self.at);
        if count.checked_mul(size).is_some_and(|needed| needed <= there) { Ok(count) } else { Err(Misfit) }
    }

    fn block(&mut self) -> Result<&'a [u8], Misfit> {
        let count = self.count(1)?;
        let block = &self.bytes[self.at..self.at + count];
        self.at += count;
        Ok(block)
    }

    /// Reads a text of a record.
    pub(crate) fn text(&mut self) -> Result<&'a str, Misfit> {
        std::str::from_utf8(self.block()?).map_err(|_| Misfit)
    }

    /// Reads a text of a message, without its terminating zero.
    pub(crate) fn closed_text(&mut self) -> Result<&'a str, Misfit> {
        let text = self.block()?;
        std::str::from_utf8(text.strip_suffix(&[0]).unwrap_or(text)).map_err(|_| Misfit)
    }

    pub(crate) fn texts(&mut self) -> Result<Vec<&'a str>, Misfit> {
        (0..self.count(4)?).map(|_| self.closed_text()).collect()
    }

    pub(crate) fn numbers(&mut self) -> Result<Vec<f64>, Misfit> {
        (0..self.count(8)?).map(|_| self.f64()).collect()
    }

    pub(crate) fn map(&mut self) -> Result<BTreeMap<String, String>, Misfit> {
        let mut entries = Reader::of_record(self.block()?);
        let mut map = BTreeMap::new();
        while !entries.rest().is_empty() {
            map.insert(entries.text()?.to_owned(), entries.text()?.to_owned());
        }
        Ok(map)
    }

    /// The unread bytes.
    pub(crate) fn rest(&self) -> &'a [u8] {
        &self.bytes[self.at..]
    }
}

/// Writes the values of a message, little-endian.
#[derive(Default)]
pub(crate) struct Writer {
    bytes: Vec<u8>,
}

impl Writer {
    fn put(&mut self, value: &[u8]) {
        self.bytes.resize(self.bytes.len().next_multiple_of(value.len()), 0);
        self.bytes.extend_from_slice(value);
    }

    pub(crate) fn u32(&mut self, value: u32) {
        self.put(&value.to_le_bytes());
    }

    pub(crate) fn i32(&mut self, value: i32) {
        self.put(&value.to_le_bytes());
    }

    pub(crate) fn f64(&mut self, value: f64) {
        self.put(&value.to_le_bytes());
    }

    pub(crate) fn text(&mut self, text: &str) {
        self.u32(text.len() as u32 + 1);
        self.bytes.extend_from_slice(text.as_bytes());
        self.bytes.push(0);
    }

    pub(crate) fn numbers<'a>(&mut self, numbers: impl ExactSizeIterator<Item = &'a f64>) {
        self.u32(numbers.len() as u32);
        numbers.for_each(|&number| self.f64(number));
    }

    /// The bytes of the message, after the four that state little-endian order.
    pub(crate) fn message(self) -> Vec<u8> {
        [&[0, 1, 0, 0], &self.bytes[..]].concat()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn packed_values_round_trip(
            seconds in any::<i32>(),
            name in "[a-zé]{0,9}",
            numbers in proptest::collection::vec(any::<f64>(), 0..9),
            cut in 1usize..9,
        ) {
            let mut writer = Writer::default();
            writer.text(&name);
            writer.i32(seconds);
            writer.numbers(numbers.iter());
            let message = writer.message();
            let mut reader = Reader::of_message(&message).unwrap();
            prop_assert_eq!(reader.closed_text().unwrap(), &name);
            prop_assert_eq!(reader.i32().unwrap(), seconds);
            let read: Vec<u64> = reader.numbers().unwrap().iter().map(|number| number.to_bits()).collect();
            prop_assert_eq!(read, numbers.iter().map(|number| number.to_bits()).collect::<Vec<_>>());
            prop_assert_eq!(reader.f64(), Err(Misfit));
            let mut cut = Reader::of_message(&message[..message.len() - cut.min(message.len() - 4)]).unwrap();
            prop_assert!(cut.closed_text().and_then(|_| cut.i32()).and_then(|_| cut.numbers()).is_err());
        }
    }

    #[test]
    fn oversized_lengths_are_refused() {
        let mut reader = Reader::of_message(&[0, 1, 0, 0, 0xf0, 0xff, 0xff, 0xff, 1]).unwrap();
        assert_eq!(reader.texts(), Err(Misfit));
        assert!(Reader::of_message(&[0]).is_err());
    }

    #[test]
    fn big_endian_is_read() {
        let mut reader = Reader::of_message(&[0, 0, 0, 0, 0, 0, 0, 7]).unwrap();
        assert_eq!(reader.u32(), Ok(7));
    }
}
