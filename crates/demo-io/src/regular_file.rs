//! Regular files. Devices have no end, and reading from a pipe may block.

use std::fs::{self, File, Metadata};
use std::io::{self, ErrorKind, Read};
use std::path::Path;
use std::time::SystemTime;

use serde::{Deserialize, Serialize};

/// Size and modification time, by which a changed file is recognised.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FileState {
    /// Size in bytes.
    pub bytes: u64,
    /// Time of the last modification, in nanoseconds since 1970.
    pub modified: i64,
}

impl FileState {
    /// The present state of a file.
    ///
    /// # Errors
    /// Errors of the operating system, and a path that is no regular file.
    pub fn of(path: &Path) -> io::Result<FileState> {
        let found = plain(path)?;
        let modified = match found.modified()?.duration_since(SystemTime::UNIX_EPOCH) {
            Ok(since) => since.as_nanos() as i64,
            Err(before) => -(before.duration().as_nanos() as i64),
        };
        Ok(FileState { bytes: found.len(), modified })
    }
}

/// Maximum size in bytes of a text written by hand, such as a configuration or the description of a robot.
const TEXT: u64 = 16 << 20;

/// Reads a text written by hand, of at most 16 MB.
///
/// # Errors
/// As [`read_bytes`], and text that is not UTF-8.
pub fn read_text(path: &Path) -> io::Result<String> {
    String::from_utf8(read_bytes(path, TEXT)?).map_err(|_| io::Error::new(ErrorKind::InvalidData, "it is not UTF-8"))
}

/// Reads the contents that a file has when it is opened, and nothing that is appended later.
///
/// # Errors
/// Errors of the operating system, a path that is no regular file, and a file of more than `most` bytes.
pub fn read_bytes(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let (file, len) = open(path)?;
    if len > most {
        return Err(too_large(most));
    }
    read_bounded(file.take(len), most)
}

/// Reads a source such as standard input to its end.
///
/// # Errors
/// Errors of the operating system, and more than `most` bytes.
pub fn read_bounded(source: impl Read, most: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    source.take(most.saturating_add(1)).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most { Err(too_large(most)) } else { Ok(bytes) }
}

fn too_large(most: u64) -> io::Error {
    io::Error::new(ErrorKind::FileTooLarge, format!("it has more than {} MB", most >> 20))
}

/// Opens a file and returns its present size in bytes.
pub(crate) fn open(path: &Path) -> io::Result<(File, u64)> {
    // Checked before opening, because opening a pipe waits for its other end.
    plain(path)?;
    let file = File::open(path)?;
    let len = file.metadata()?.len();
    Ok((file, len))
}

fn plain(path: &Path) -> io::Result<Metadata> {
    let found = fs::metadata(path)?;
    if found.is_file() {
        return Ok(found);
    }
    let what = if found.is_dir() { "it is a folder" } else { "it is a pipe or a device; name a file" };
    Err(io::Error::new(ErrorKind::InvalidInput, what))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_beyond_the_limit_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.toml");
        fs::write(&path, "a = 1").unwrap();
        assert_eq!(read_text(&path).unwrap(), "a = 1");
        assert_eq!(read_bytes(&path, 5).unwrap(), b"a = 1");
        assert_eq!(read_bytes(&path, 4).unwrap_err().kind(), ErrorKind::FileTooLarge);
        assert_eq!(read_bounded(io::repeat(0), 1 << 20).unwrap_err().to_string(), "it has more than 1 MB");
        assert_eq!(read_bytes(folder.path(), 5).unwrap_err().kind(), ErrorKind::InvalidInput);
        fs::write(&path, [0xff]).unwrap();
        assert_eq!(read_text(&path).unwrap_err().to_string(), "it is not UTF-8");
        File::create(&path).unwrap().set_len(1 << 40).unwrap();
        assert_eq!(read_text(&path).unwrap_err().to_string(), "it has more than 16 MB");
    }
}
