//! Common Data Representation, as ROS 2 puts messages into bytes.

/// Reads values one after another, each aligned to its size from behind the four bytes that say the byte order.
pub(crate) struct Cdr<'a> {
    bytes: &'a [u8],
    at: usize,
    big_endian: bool,
    /// Largest alignment: 8, in the second version 4.
    widest: usize,
}

/// The message ends before what it announces.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Short;

impl<'a> Cdr<'a> {
    pub(crate) fn new(message: &'a [u8]) -> Result<Self, Short> {
        let (head, bytes) = message.split_at_checked(4).ok_or(Short)?;
        Ok(Self { bytes, at: 0, big_endian: head[1] % 2 == 0, widest: if head[1] >= 6 { 4 } else { 8 } })
    }

    fn take<const N: usize>(&mut self) -> Result<[u8; N], Short> {
        let start = self.at.next_multiple_of(N.min(self.widest));
        let bytes = self.bytes.get(start..start + N).ok_or(Short)?;
        self.at = start + N;
        let mut value = [0; N];
        value.copy_from_slice(bytes);
        if self.big_endian {
            value.reverse();
        }
        Ok(value)
    }

    pub(crate) fn u32(&mut self) -> Result<u32, Short> {
        Ok(u32::from_le_bytes(self.take()?))
    }

    pub(crate) fn i32(&mut self) -> Result<i32, Short> {
        Ok(i32::from_le_bytes(self.take()?))
    }

    pub(crate) fn f64(&mut self) -> Result<f64, Short> {
        Ok(f64::from_le_bytes(self.take()?))
    }

    /// A number of elements of at least `size` bytes, which are there.
    fn count(&mut self, size: usize) -> Result<usize, Short> {
        let count = self.u32()? as usize;
        let there = self.bytes.len().saturating_sub(self.at);
        if count.checked_mul(size).is_some_and(|needed| needed <= there) { Ok(count) } else { Err(Short) }
    }

    /// Without its closing zero.
    pub(crate) fn text(&mut self) -> Result<&'a str, Short> {
        let count = self.count(1)?;
        let bytes = &self.bytes[self.at..self.at + count];
        self.at += count;
        std::str::from_utf8(bytes.strip_suffix(&[0]).unwrap_or(bytes)).map_err(|_| Short)
    }

    pub(crate) fn texts(&mut self) -> Result<Vec<&'a str>, Short> {
        (0..self.count(4)?).map(|_| self.text()).collect()
    }

    pub(crate) fn numbers(&mut self) -> Result<Vec<f64>, Short> {
        (0..self.count(8)?).map(|_| self.f64()).collect()
    }
}

/// Writes little-endian values.
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

    pub(crate) fn text(&mut self, text: &str) {
        self.u32(text.len() as u32 + 1);
        self.bytes.extend_from_slice(text.as_bytes());
        self.bytes.push(0);
    }

    pub(crate) fn numbers<'a>(&mut self, numbers: impl ExactSizeIterator<Item = &'a f64>) {
        self.u32(numbers.len() as u32);
        numbers.for_each(|number| self.put(&number.to_le_bytes()));
    }

    /// With the four bytes that say little-endian.
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
        fn what_is_written_is_read(
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
            let mut cdr = Cdr::new(&message).unwrap();
            prop_assert_eq!(cdr.text().unwrap(), &name);
            prop_assert_eq!(cdr.i32().unwrap(), seconds);
            let read: Vec<u64> = cdr.numbers().unwrap().iter().map(|number| number.to_bits()).collect();
            prop_assert_eq!(read, numbers.iter().map(|number| number.to_bits()).collect::<Vec<_>>());
            prop_assert_eq!(cdr.f64(), Err(Short));
            let mut cut = Cdr::new(&message[..message.len() - cut.min(message.len() - 4)]).unwrap();
            prop_assert!(cut.text().and_then(|_| cut.i32()).and_then(|_| cut.numbers()).is_err());
        }
    }

    #[test]
    fn a_lying_length_allocates_nothing() {
        let mut cdr = Cdr::new(&[0, 1, 0, 0, 0xf0, 0xff, 0xff, 0xff, 1]).unwrap();
        assert_eq!(cdr.texts(), Err(Short));
        assert!(Cdr::new(&[0]).is_err());
    }

    #[test]
    fn big_endian_is_read() {
        let mut cdr = Cdr::new(&[0, 0, 0, 0, 0, 0, 0, 7]).unwrap();
        assert_eq!(cdr.u32(), Ok(7));
    }
}
