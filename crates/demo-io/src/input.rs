//! A file before its format is known.

use std::fs::File;
use std::io::Read as _;
use std::path::{Path, PathBuf};

use crate::{Fault, ReadError, ReadOptions};

/// A file to be read, with its first bytes.
pub(crate) struct Input<'a> {
    pub(crate) path: PathBuf,
    /// Without folders, for messages.
    pub(crate) name: String,
    /// Without folders and extension: the name of a movement that has none.
    pub(crate) stem: String,
    /// Bytes in all.
    pub(crate) len: u64,
    /// The first of them.
    pub(crate) head: Vec<u8>,
    pub(crate) options: &'a ReadOptions,
}

/// Enough for the header of thousands of columns.
const HEAD: u64 = 256 << 10;

impl<'a> Input<'a> {
    pub(crate) fn new(path: &Path, options: &'a ReadOptions) -> Result<Self, ReadError> {
        let name = name_of(path);
        let unreadable = |error: std::io::Error| unreadable(&error, &name);
        let file = File::open(path).map_err(unreadable)?;
        let len = file.metadata().map_err(unreadable)?.len();
        let mut head = Vec::new();
        file.take(HEAD).read_to_end(&mut head).map_err(unreadable)?;
        let stem = path.file_stem().map_or_else(|| name.clone(), |stem| stem.to_string_lossy().into_owned());
        Ok(Self { path: path.to_owned(), name, stem, len, head, options })
    }

    pub(crate) fn open(&self) -> Result<File, ReadError> {
        File::open(&self.path).map_err(|error| unreadable(&error, &self.name))
    }
}

pub(crate) fn name_of(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

pub(crate) fn unreadable(error: &std::io::Error, name: &str) -> ReadError {
    match error.kind() {
        std::io::ErrorKind::NotFound => ReadError::MissingFile(Fault::new(
            "there is no such file",
            name,
            "another path: it counts from the current folder",
        )),
        _ => ReadError::Unreadable(Fault::new(
            format!("cannot be read: {error}"),
            name,
            "another file, or other permissions",
        )),
    }
}
