use std::io;
use std::path::{Path, PathBuf};

use demo_io::TempFile;

/// Writes a whole file or nothing ([`demo_io::write_whole`]): what stood there before stays until everything is on the
/// disk.
///
/// # Errors
/// What the system says.
pub fn write_whole(path: &Path, contents: &[u8]) -> io::Result<()> {
    demo_io::write_whole(path, |file| file.write_all(contents))
}

/// Writes files that belong together: none is replaced before all are on the disk.
///
/// # Errors
/// The first file that cannot be written, and what the system says.
pub fn write_together<T: AsRef<[u8]>>(files: &[(PathBuf, T)]) -> Result<(), (PathBuf, io::Error)> {
    let draft = |(path, contents): &(PathBuf, T)| {
        TempFile::of(path, |file| file.write_all(contents.as_ref())).map_err(|error: io::Error| (path.clone(), error))
    };
    let drafts = files.iter().map(draft).collect::<Result<Vec<_>, _>>()?;
    let mut replaced = drafts.into_iter().zip(files);
    replaced.try_for_each(|(draft, (path, _))| draft.persist().map_err(|error| (path.clone(), error)))
}
