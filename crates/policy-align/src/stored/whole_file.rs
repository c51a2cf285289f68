use std::io;
use std::path::{Path, PathBuf};

use demo_io::TempFile;

/// Writes a file completely or not at all ([`demo_io::write_whole`]). A previous file stays until everything is on
/// disk.
///
/// # Errors
/// The system's error.
pub fn write_whole(path: &Path, contents: &[u8]) -> io::Result<()> {
    demo_io::write_whole(path, |file| file.write_all(contents))
}

/// Writes files that belong together: none is replaced before all are on disk.
///
/// # Errors
/// The first file that cannot be written, with the system's error.
pub fn write_together<T: AsRef<[u8]>>(files: &[(PathBuf, T)]) -> Result<(), (PathBuf, io::Error)> {
    let draft = |(path, contents): &(PathBuf, T)| {
        TempFile::of(path, |file| file.write_all(contents.as_ref())).map_err(|error: io::Error| (path.clone(), error))
    };
    let drafts = files.iter().map(draft).collect::<Result<Vec<_>, _>>()?;
    let mut replaced = drafts.into_iter().zip(files);
    replaced.try_for_each(|(draft, (path, _))| draft.persist().map_err(|error| (path.clone(), error)))
}
