//! Atomic writing: a file is written completely or not at all.

use std::fs::{self, File};
use std::io::{self, BufWriter, Seek, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use tempfile::NamedTempFile;

/// Prefix and suffix of the names of drafts.
const PREFIX: &str = ".policy-align-";
const SUFFIX: &str = ".part";

/// Longer than a new draft remains without its lock.
const UNLOCKED: Duration = Duration::from_secs(60);

/// Drafts that this process is writing.
static DRAFTS: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Destination of the bytes of a file.
pub trait Sink: Write + Seek {}

impl<T: Write + Seek> Sink for T {}

/// Writes a whole file or nothing: `fill` writes to a draft in the same folder, which replaces an old file once all bytes are
/// on disk. The old file's permissions are kept, and links to it stay valid.
///
/// A pipe or device is written to directly.
///
/// # Errors
/// Errors of the operating system or of `fill`.
pub fn write_whole<E: From<io::Error>>(
    path: &Path,
    fill: impl FnOnce(&mut dyn Sink) -> Result<(), E>,
) -> Result<(), E> {
    Ok(TempFile::of(path, fill)?.persist()?)
}

/// Removes the drafts of this process and prevents new ones, before the process ends abruptly, as after an interrupt. Old
/// files stay.
pub fn abandon_drafts() {
    let drafts = drafts();
    for draft in drafts.iter() {
        // The process is ending, so a failure is ignored.
        let _ = fs::remove_file(draft);
    }
    std::mem::forget(drafts);
}

fn drafts() -> MutexGuard<'static, Vec<PathBuf>> {
    DRAFTS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A file on disk that is not yet in its place. Files that belong together can thus all be written before the first one is
/// replaced.
pub struct TempFile {
    place: PathBuf,
    /// `None` if the destination is no regular file.
    held: Option<(NamedTempFile, Known)>,
}

/// A draft that [`abandon_drafts`] would remove, while this value exists.
struct Known(PathBuf);

impl TempFile {
    /// As [`write_whole`], but an old file stays until [`persist`](Self::persist).
    ///
    /// # Errors
    /// Errors of the operating system or of `fill`.
    pub fn of<E: From<io::Error>>(
        path: &Path,
        fill: impl FnOnce(&mut dyn Sink) -> Result<(), E>,
    ) -> Result<TempFile, E> {
        // A link stays a link: its target is replaced.
        let place = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        if fs::metadata(&place).is_ok_and(|found| !found.is_file()) {
            let mut file = BufWriter::new(File::options().write(true).open(&place)?);
            fill(&mut file)?;
            file.flush()?;
            return Ok(TempFile { place, held: None });
        }
        let (held, known) = begun(&place)?;
        let mut file = BufWriter::with_capacity(1 << 16, held.as_file());
        fill(&mut file)?;
        file.flush()?;
        drop(file);
        held.as_file().sync_all()?;
        Ok(TempFile { place, held: Some((held, known)) })
    }

    /// Moves the file to its place and replaces an old one.
    ///
    /// # Errors
    /// Errors of the operating system.
    pub fn persist(self) -> io::Result<()> {
        let Some((file, known)) = self.held else { return Ok(()) };
        // The lock prevents an interrupt in between.
        let drafts = drafts();
        let persisted = file.persist(&self.place);
        drop(drafts);
        drop(known);
        persisted.map(|_| ()).map_err(|error| error.error)
    }
}

/// Creates a draft with the permissions of the old file, or those of any new file. It stays locked while it is written.
fn begun(place: &Path) -> io::Result<(NamedTempFile, Known)> {
    let folder = place.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    remove_abandoned(folder);
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX).suffix(SUFFIX);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        let permissions = fs::metadata(place).map(|found| found.permissions());
        builder.permissions(permissions.unwrap_or_else(|_| fs::Permissions::from_mode(0o666)));
    }
    let mut drafts = drafts();
    let file = builder.tempfile_in(folder)?;
    // Without locks, drafts are never considered abandoned.
    let _ = file.as_file().try_lock();
    drafts.push(file.path().to_owned());
    let known = Known(file.path().to_owned());
    Ok((file, known))
}

/// Removes drafts that killed programs left in a folder.
fn remove_abandoned(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        let is_draft = name.starts_with(PREFIX) && name.ends_with(SUFFIX);
        if is_draft && entry.file_type().is_ok_and(|kind| kind.is_file()) && is_abandoned(&entry.path()) {
            // Another program may have removed it already.
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Whether no process holds the lock and the draft is old enough to have had one.
fn is_abandoned(draft: &Path) -> bool {
    let Ok(file) = File::open(draft) else { return false };
    let age = file.metadata().and_then(|found| found.modified()).ok().and_then(|time| time.elapsed().ok());
    age.is_some_and(|age| age > UNLOCKED) && file.try_lock().is_ok()
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

    #[test]
    fn all_drafts_are_written_before_any_file_is_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let [model, page] = ["model.json", "model.html"].map(|name| folder.path().join(name));
        for path in [&model, &page] {
            put(path, "old").unwrap();
        }
        let draft = |path: &Path, text: &str| TempFile::of(path, |file| file.write_all(text.as_bytes()));
        let begun = draft(&model, "new").unwrap();
        assert!(draft(&folder.path().join("none/model.html"), "new").is_err());
        drop(begun);
        assert_eq!(fs::read_to_string(&model).unwrap(), "old");
        let begun = [draft(&model, "new").unwrap(), draft(&page, "new").unwrap()];
        assert_eq!(fs::read_to_string(&model).unwrap(), "old");
        for draft in begun {
            draft.persist().unwrap();
        }
        assert_eq!([&model, &page].map(|path| fs::read_to_string(path).unwrap()), ["new", "new"]);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
    }

    #[test]
    fn drafts_of_killed_programs_are_removed_and_no_others() {
        let folder = tempfile::tempdir().unwrap();
        let made = |name: &str, minutes: u64| {
            let path = folder.path().join(name);
            let file = File::create(&path).unwrap();
            file.set_modified(std::time::SystemTime::now() - Duration::from_secs(60 * minutes)).unwrap();
            (path, file)
        };
        let killed = made(".policy-align-a.part", 10).0;
        let (written, file) = made(".policy-align-b.part", 10);
        file.lock().unwrap();
        let kept = [written, made(".policy-align-c.part", 0).0, made(".other-d.part", 10).0];
        put(&folder.path().join("model.json"), "x").unwrap();
        assert!(!killed.exists() && kept.iter().all(|path| path.exists()));
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
