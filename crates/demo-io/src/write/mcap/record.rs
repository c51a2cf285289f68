use std::collections::BTreeMap;
use std::io::{self, Write};

use crc32fast::Hasher;

/// A record under construction.
pub(super) struct Record {
    pub(super) kind: u8,
    pub(super) content: Vec<u8>,
}

impl Record {
    pub(super) fn new(kind: u8) -> Self {
        Self { kind, content: Vec::new() }
    }

    pub(super) fn bytes(&mut self, bytes: &[u8]) {
        self.content.extend_from_slice(bytes);
    }

    pub(super) fn u16(&mut self, value: u16) {
        self.bytes(&value.to_le_bytes());
    }

    pub(super) fn u32(&mut self, value: u32) {
        self.bytes(&value.to_le_bytes());
    }

    pub(super) fn u64(&mut self, value: u64) {
        self.bytes(&value.to_le_bytes());
    }

    pub(super) fn text(&mut self, text: &str) {
        self.u32(text.len() as u32);
        self.bytes(text.as_bytes());
    }

    pub(super) fn map(&mut self, entries: &BTreeMap<String, String>) {
        self.block(|block| {
            for (key, value) in entries {
                block.text(key);
                block.text(value);
            }
        });
    }

    /// Adds the output of `fill`, preceded by its length.
    pub(super) fn block(&mut self, fill: impl FnOnce(&mut Self)) {
        let start = self.content.len();
        self.u32(0);
        fill(self);
        let length = (self.content.len() - start - 4) as u32;
        self.content[start..start + 4].copy_from_slice(&length.to_le_bytes());
    }

    pub(super) fn write(&self, out: &mut impl Write) -> io::Result<()> {
        out.write_all(&[self.kind])?;
        out.write_all(&(self.content.len() as u64).to_le_bytes())?;
        out.write_all(&self.content)
    }
}

/// Destination of bytes, which counts them and computes their checksum.
pub(super) struct Out<W> {
    inner: W,
    /// Number of bytes written.
    pub(super) position: u64,
    /// Checksum of the bytes written since the last reset.
    pub(super) sum: Hasher,
}

impl<W: Write> Out<W> {
    pub(super) fn new(inner: W) -> Self {
        Self { inner, position: 0, sum: Hasher::new() }
    }
}

impl<W: Write> Write for Out<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.inner.write(bytes)?;
        self.position += written as u64;
        self.sum.update(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}
