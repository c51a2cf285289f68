use std::io::{self, BufReader, Read};

use crc32fast::Hasher;

/// Number of bytes to read at once.
const BLOCK: usize = 256 << 10;

/// A reader that computes the checksum of its bytes and records whether they ended.
pub(super) struct ChecksumReader<R> {
    inner: R,
    sum: Hasher,
    /// Whether a read went beyond the end.
    pub(super) ended: bool,
}

impl<R: Read> ChecksumReader<R> {
    pub(super) fn new(inner: R) -> Self {
        Self { inner, sum: Hasher::new(), ended: false }
    }

    /// CRC-32 of all bytes read so far.
    pub(super) fn sum(&self) -> u32 {
        self.sum.clone().finalize()
    }
}

impl<R: Read> Read for ChecksumReader<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.inner.read(buffer)?;
        self.ended |= read == 0 && !buffer.is_empty();
        self.sum.update(&buffer[..read]);
        Ok(read)
    }
}

/// A reader that reports the number of bytes it has read.
pub(super) struct ProgressReader<'a, R> {
    inner: R,
    progress: &'a mut dyn FnMut(u64),
}

impl<'a, R: Read> ProgressReader<'a, R> {
    pub(super) fn new(inner: R, progress: &'a mut dyn FnMut(u64)) -> BufReader<Self> {
        BufReader::with_capacity(BLOCK, Self { inner, progress })
    }
}

impl<R: Read> Read for ProgressReader<'_, R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.inner.read(buffer)?;
        (self.progress)(read as u64);
        Ok(read)
    }
}

/// Kind and length of the next record; `None` at the end of the source.
pub(super) fn head(source: &mut impl Read) -> io::Result<Option<(u8, u64)>> {
    let mut kind = [0];
    if source.read(&mut kind)? == 0 {
        return Ok(None);
    }
    let mut length = [0; 8];
    source.read_exact(&mut length)?;
    Ok(Some((kind[0], u64::from_le_bytes(length))))
}

/// The contents of a record. Allocates only for bytes that exist, not for all of `length`.
pub(super) fn content<'b>(source: &mut impl Read, length: u64, buffer: &'b mut Vec<u8>) -> io::Result<&'b [u8]> {
    buffer.clear();
    while (buffer.len() as u64) < length {
        let start = buffer.len();
        let step = (length - start as u64).min(BLOCK.max(start / 4) as u64) as usize;
        buffer.reserve_exact(step);
        buffer.resize(start + step, 0);
        source.read_exact(&mut buffer[start..])?;
    }
    Ok(buffer)
}

/// Skips `length` bytes.
pub(super) fn skip(source: &mut impl Read, length: u64) -> io::Result<()> {
    let passed = io::copy(&mut source.take(length), &mut io::sink())?;
    if passed == length { Ok(()) } else { Err(io::ErrorKind::UnexpectedEof.into()) }
}
