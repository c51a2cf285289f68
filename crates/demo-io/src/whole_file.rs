//! Files that are written whole or not at all.

use std::fs::{self, File};
use std::io::{self, BufWriter, Seek, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use tempfile::NamedTempFile;

/// Drafts that are being written by this process.
static DRAFTS: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// What a file is written to.
pub trait Sink: Write + Seek {}

impl<T: Write + Seek> Sink for T {}

/// Writes a whole file or nothing: `fill` writes to a draft beside it, and what stood there before stays until everything
/// is on the disk. Rights and links of an old file stay.
///
/// What is not a plain file, as a pipe, is written to as it is.
///
/// # Errors
/// What the system says, or `fill`.
pub fn write_whole<E: From<io::Error>>(
    path: &Path,
    fill: impl FnOnce(&mut dyn Sink) -> Result<(), E>,
) -> Result<(), E> {
    // A link stays a link: the file behind it is replaced.
    let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    if fs::metadata(&path).is_ok_and(|found| !found.is_file()) {
        let mut file = BufWriter::new(File::options().write(true).open(&path)?);
        fill(&mut file)?;
        return Ok(file.flush()?);
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let draft = Draft::in_folder(folder, &path)?;
    let mut file = BufWriter::with_capacity(1 << 16, draft.file.as_file());
    fill(&mut file)?;
    file.flush()?;
    drop(file);
    draft.file.as_file().sync_all()?;
    draft.becomes(&path)?;
    Ok(())
}

/// Removes drafts that are being written, and keeps others from being begun: for who ends the process at once, as an
/// interrupt does. Files that stood there before stay.
pub fn abandon_drafts() {
    let drafts = drafts();
    for draft in drafts.iter() {
        // The process ends; there is nobody to tell.
        let _ = fs::remove_file(draft);
    }
    std::mem::forget(drafts);
}

fn drafts() -> MutexGuard<'static, Vec<PathBuf>> {
    DRAFTS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A file on its way.
struct Draft {
    file: NamedTempFile,
    known: Known,
}

/// What [`abandon_drafts`] would remove, as long as this lives.
struct Known(PathBuf);

impl Draft {
    /// A new file that only its owner's rights of the old one, or those of any new file, are given to.
    fn in_folder(folder: &Path, path: &Path) -> io::Result<Draft> {
        let mut builder = tempfile::Builder::new();
        builder.prefix(".policy-align-").suffix(".part");
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt as _;
            let kept = fs::metadata(path).map(|found| found.permissions());
            builder.permissions(kept.unwrap_or_else(|_| fs::Permissions::from_mode(0o666)));
        }
        #[cfg(not(unix))]
        let _ = path;
        let mut drafts = drafts();
        let file = builder.tempfile_in(folder)?;
        drafts.push(file.path().to_owned());
        let known = Known(file.path().to_owned());
        Ok(Draft { file, known })
    }

    fn becomes(self, path: &Path) -> io::Result<()> {
        let Draft { file, known } = self;
        // An interrupt comes before or after.
        let drafts = drafts();
        let persisted = file.persist(path);
        drop(drafts);
        drop(known);
        persisted.map(|_| ()).map_err(|error| error.error)
    }
}

impl Drop for Known {
    fn drop(&mut self) {
        drafts().retain(|draft| *draft != self.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn put(path: &Path, text: &str) -> io::Result<()> {
        write_whole(path, |file| file.write_all(text.as_bytes()))
    }

    #[test]
    fn a_file_is_replaced_and_nothing_is_left_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("model.json");
        for text in ["first", "second"] {
            put(&path, text).unwrap();
            assert_eq!(fs::read_to_string(&path).unwrap(), text);
        }
        let fails = write_whole(&path, |file| {
            file.write_all(b"half")?;
            Err(io::Error::other("no more"))
        });
        assert_eq!(fails.unwrap_err().to_string(), "no more");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
        assert!(put(&folder.path().join("none/model.json"), "x").is_err());
        assert!(put(folder.path(), "x").is_err());
        assert_eq!(fs::read_to_string(&path).unwrap(), "second");
    }

    #[cfg(unix)]
    #[test]
    fn rights_and_links_stay() {
        use std::os::unix::fs::{PermissionsExt as _, symlink};
        let folder = tempfile::tempdir().unwrap();
        let (path, link) = (folder.path().join("model.json"), folder.path().join("link.json"));
        fs::write(&path, "old").unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).unwrap();
        symlink(&path, &link).unwrap();
        put(&link, "new").unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "new");
        assert_eq!(fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o640);
        assert!(fs::symlink_metadata(&link).unwrap().file_type().is_symlink());
    }
}
