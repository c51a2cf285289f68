use std::collections::BTreeMap;

/// Takes the content of a record apart, field by field.
pub(super) struct Fields<'a> {
    bytes: &'a [u8],
}

/// The record ends before its fields, or a text is none.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
#[error("a record does not hold what its kind asks for")]
pub(super) struct Misfit;

impl<'a> Fields<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { bytes }
    }

    fn take(&mut self, length: usize) -> Result<&'a [u8], Misfit> {
        let (taken, rest) = self.bytes.split_at_checked(length).ok_or(Misfit)?;
        self.bytes = rest;
        Ok(taken)
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], Misfit> {
        self.take(N)?.try_into().map_err(|_| Misfit)
    }

    pub(super) fn u16(&mut self) -> Result<u16, Misfit> {
        Ok(u16::from_le_bytes(self.array()?))
    }

    pub(super) fn u32(&mut self) -> Result<u32, Misfit> {
        Ok(u32::from_le_bytes(self.array()?))
    }

    pub(super) fn u64(&mut self) -> Result<u64, Misfit> {
        Ok(u64::from_le_bytes(self.array()?))
    }

    fn block(&mut self) -> Result<&'a [u8], Misfit> {
        let length = self.u32()?;
        self.take(length as usize)
    }

    pub(super) fn text(&mut self) -> Result<&'a str, Misfit> {
        std::str::from_utf8(self.block()?).map_err(|_| Misfit)
    }

    pub(super) fn map(&mut self) -> Result<BTreeMap<String, String>, Misfit> {
        let mut entries = Fields::new(self.block()?);
        let mut map = BTreeMap::new();
        while !entries.bytes.is_empty() {
            map.insert(entries.text()?.to_owned(), entries.text()?.to_owned());
        }
        Ok(map)
    }

    /// What no field took.
    pub(super) fn rest(self) -> &'a [u8] {
        self.bytes
    }
}
