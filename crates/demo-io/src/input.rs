//! A file whose format is not yet known.

use std::cell::Cell;
use std::fs::File;
use std::io::Read as _;
use std::path::{Path, PathBuf};

use crate::{Fault, ReadError, ReadOptions, SamplesAre, regular_file};

/// A file to read, with its first bytes.
pub(crate) struct Input<'a> {
    pub(crate) path: PathBuf,
    /// File name without folders, for messages.
    pub(crate) name: String,
    /// File name without folders and extension: the name of a movement that has none.
    pub(crate) stem: String,
    /// Size in bytes.
    pub(crate) len: u64,
    /// The first bytes.
    pub(crate) head: Vec<u8>,
    pub(crate) options: &'a ReadOptions,
    /// Whether arrays are passed on with their indices in reverse order, because the format stores columns first.
    pub(crate) columns_first: bool,
    /// Bytes of memory that reading may still take.
    budget: Cell<u64>,
}

/// Any file may grow to this size in memory.
const MEMORY: u64 = 48 << 20;

/// Enough for the header of thousands of columns.
const HEAD: u64 = 256 << 10;

impl<'a> Input<'a> {
    pub(crate) fn new(path: &Path, options: &'a ReadOptions) -> Result<Self, ReadError> {
        let name = name_of(path);
        let unreadable = |error: std::io::Error| unreadable(&error, &path.display().to_string());
        let (file, len) = regular_file::open(path).map_err(unreadable)?;
        let mut head = Vec::new();
        file.take(len.min(HEAD)).read_to_end(&mut head).map_err(unreadable)?;
        let stem = path.file_stem().map_or_else(|| name.clone(), |stem| stem.to_string_lossy().into_owned());
        Ok(Self {
            path: path.to_owned(),
            name,
            stem,
            len,
            head,
            options,
            columns_first: false,
            budget: Cell::new(len.saturating_mul(64).saturating_add(MEMORY)),
        })
    }

    /// The layout of samples in arrays as they are passed on.
    pub(crate) fn samples_are(&self) -> Option<SamplesAre> {
        match (self.options.samples_are, self.columns_first) {
            (Some(SamplesAre::Rows), true) => Some(SamplesAre::Columns),
            (Some(SamplesAre::Columns), true) => Some(SamplesAre::Rows),
            (asked, _) => asked,
        }
    }

    /// The layout of arrays that would exchange rows and columns, as a value of `--samples-are`.
    pub(crate) fn other_layout(&self) -> &'static str {
        let usual = if self.columns_first { SamplesAre::Columns } else { SamplesAre::Rows };
        match self.options.samples_are.unwrap_or(usual) {
            SamplesAre::Rows => "columns",
            SamplesAre::Columns => "rows",
        }
    }

    /// Requests memory before it is allocated. Unless the file is trusted, all that it unpacks to is at most 64 times its
    /// size.
    pub(crate) fn charge(&self, bytes: u64) -> Result<(), ReadError> {
        match self.budget.get().checked_sub(bytes) {
            Some(left) => self.budget.set(left),
            None if self.options.trust => {}
            None => {
                let what = format!("{} bytes unpack to more than 64 times as much", self.len);
                return Err(ReadError::grows(what, &self.name));
            }
        }
        Ok(())
    }

    /// Whether these are the file's last bytes.
    #[cfg(feature = "parquet")]
    pub(crate) fn ends_with(&self, mark: &[u8]) -> bool {
        let length = mark.len() as u64;
        let end = self.open().and_then(|mut file| self.part(&mut file, self.len.saturating_sub(length), length));
        end.is_ok_and(|end| end == mark)
    }

    /// Reads `length` bytes of the open file from `start`; fewer at its end.
    #[cfg(feature = "parquet")]
    pub(crate) fn part(&self, file: &mut File, start: u64, length: u64) -> Result<Vec<u8>, ReadError> {
        use std::io::{Seek as _, SeekFrom};
        let mut bytes = Vec::new();
        let read = file.seek(SeekFrom::Start(start)).and_then(|_| file.take(length).read_to_end(&mut bytes));
        read.map_err(|error| unreadable(&error, &self.name))?;
        Ok(bytes)
    }

    /// Reads all bytes of the file.
    #[cfg(feature = "mat")]
    pub(crate) fn whole(&self, progress: &mut dyn FnMut(u64)) -> Result<Vec<u8>, ReadError> {
        let mut bytes = Vec::new();
        self.open()?.read_to_end(&mut bytes).map_err(|error| unreadable(&error, &self.name))?;
        progress(bytes.len() as u64);
        Ok(bytes)
    }

    pub(crate) fn open(&self) -> Result<File, ReadError> {
        File::open(&self.path).map_err(|error| unreadable(&error, &self.path.display().to_string()))
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
            "check the path (relative to the current folder)",
        )),
        _ => ReadError::Unreadable(Fault::new(format!("cannot be read: {error}"), name, "check its permissions")),
    }
}

/// The error for bytes that failed to decompress or to match their checksum.
pub(crate) fn damaged(error: &std::io::Error, file: &str) -> ReadError {
    ReadError::corrupt(format!("the data are damaged: {error}"), file)
}
