//! Saves results in a file as they are finished, so that a program can resume after an interruption or a kill.
//!
//! The first line contains the kind of journal. Every other line is one record: the SHA-256 of its text, a blank, and JSON. A torn or
//! changed line is counted and skipped; only that record is lost.

mod line;

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufRead as _, BufReader, ErrorKind, Read as _, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use serde::Serialize;
use serde::de::DeserializeOwned;

/// A journal that is open for appending. If the file system supports locks, no other process can open it at the same time.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    kind: String,
    file: Mutex<File>,
}

/// The contents of a journal.
#[derive(Debug, Clone, PartialEq)]
pub struct Contents<T> {
    /// The records in the order in which they were appended.
    pub records: Vec<T>,
    /// Number of lines that are torn, changed, or records of another form.
    pub damaged: usize,
}

impl Journal {
    /// Opens or creates a journal of this `kind`, a line of text, and reads its contents. If the last line is torn, it is terminated.
    ///
    /// # Errors
    /// [`ErrorKind::WouldBlock`] if another process has it open; [`ErrorKind::AlreadyExists`] for a link, a folder, or a file that is
    /// not a journal of this kind, which is left unchanged; and the system's errors.
    pub fn open<T: DeserializeOwned>(path: &Path, kind: &str) -> io::Result<(Journal, Contents<T>)> {
        let mut file = locked(path, kind)?;
        let contents = records(&file)?;
        // This includes a journal that was interrupted at once, which contains only a part of the first line.
        if file.metadata()?.len() <= kind.len() as u64 {
            begin(&mut file, kind)?;
        } else {
            file.seek(SeekFrom::End(-1))?;
            let mut last = [0];
            file.read_exact(&mut last)?;
            if last != *b"\n" {
                file.write_all(b"\n")?;
            }
        }
        let (path, kind) = (path.to_owned(), kind.to_owned());
        Ok((Journal { path, kind, file: Mutex::new(file) }, contents))
    }

    /// Writes a record to the system at once, completely or not at all.
    ///
    /// # Errors
    /// [`ErrorKind::InvalidData`] for a record that is not JSON, and the system's errors.
    pub fn append(&self, record: &impl Serialize) -> io::Result<()> {
        let line = line::of(record)?;
        let mut file = self.writing();
        let end = file.seek(SeekFrom::End(0))?;
        file.write_all(&line).inspect_err(|_| {
            // Otherwise the next line would be torn as well.
            let _ = file.set_len(end);
        })
    }

    /// Removes all records.
    ///
    /// # Errors
    /// The system's errors.
    pub fn clear(&self) -> io::Result<()> {
        begin(&mut self.writing(), &self.kind)
    }

    /// Blocks every write while the guard exists, so that the process may end without tearing a line.
    pub fn writing(&self) -> MutexGuard<'_, File> {
        self.file.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Its path.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

impl Drop for Journal {
    /// Closing is not sufficient: a process that was forked in the meantime also has the file open.
    fn drop(&mut self) {
        let _ = self.writing().unlock();
    }
}

/// Reads a journal of this `kind`, which may be open elsewhere, except on Windows.
///
/// # Errors
/// [`ErrorKind::AlreadyExists`] if it is of another kind, and the system's errors.
pub fn read<T: DeserializeOwned>(path: &Path, kind: &str) -> io::Result<Contents<T>> {
    let mut file = File::open(path)?;
    require_kind(&mut file, kind)?;
    records(&file)
}

/// Removes a journal of this `kind` that no process has open; other files are left unchanged.
pub fn remove(path: &Path, kind: &str) {
    // While it is locked, no other process starts to write. If it cannot be removed, it will be reused or started anew.
    if path.exists()
        && let Ok(file) = locked(path, kind)
    {
        let _ = fs::remove_file(path);
        let _ = file.unlock();
    }
}

/// Opens or creates a file of this `kind` that no other process has open, and locks it.
fn locked(path: &Path, kind: &str) -> io::Result<File> {
    if fs::symlink_metadata(path).is_ok_and(|found| !found.is_file()) {
        return Err(of_another_kind());
    }
    // Not in append mode, in which Windows cannot truncate a file.
    let mut file = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path)?;
    if let Err(fs::TryLockError::WouldBlock) = file.try_lock() {
        return Err(in_use());
    }
    if !is_at(path, &file) {
        // The file was removed or replaced between opening and locking.
        return Err(in_use());
    }
    require_kind(&mut file, kind)?;
    Ok(file)
}

fn begin(file: &mut File, kind: &str) -> io::Result<()> {
    file.set_len(0)?;
    file.seek(SeekFrom::Start(0))?;
    writeln!(file, "{kind}")
}

/// Whether the path refers to this file itself, and not to a link to it.
#[cfg(unix)]
fn is_at(path: &Path, file: &File) -> bool {
    use std::os::unix::fs::MetadataExt as _;
    let place = |found: fs::Metadata| (found.dev(), found.ino());
    let (there, own) = (fs::symlink_metadata(path).map(place), file.metadata().map(place));
    matches!((there, own), (Ok(there), Ok(own)) if there == own)
}

/// On these systems an open file cannot be replaced.
#[cfg(not(unix))]
fn is_at(_path: &Path, _file: &File) -> bool {
    true
}

/// Checks the first line, of which an interrupted journal may contain only a part.
fn require_kind(file: &mut File, kind: &str) -> io::Result<()> {
    let mut first = Vec::new();
    file.take(kind.len() as u64 + 1).read_to_end(&mut first)?;
    if format!("{kind}\n").as_bytes().starts_with(&first) { Ok(()) } else { Err(of_another_kind()) }
}

/// Reads all lines from the current position.
fn records<T: DeserializeOwned>(file: &File) -> io::Result<Contents<T>> {
    let reader = BufReader::new(file);
    let mut contents = Contents { records: Vec::new(), damaged: 0 };
    for line in reader.split(b'\n') {
        let line = line?;
        match line::read(&line) {
            Some(record) => contents.records.push(record),
            None if line.is_empty() => {}
            None => contents.damaged += 1,
        }
    }
    Ok(contents)
}

fn in_use() -> io::Error {
    io::Error::new(ErrorKind::WouldBlock, "another process is writing it")
}

fn of_another_kind() -> io::Error {
    io::Error::new(ErrorKind::AlreadyExists, "it exists and is something else")
}

#[cfg(test)]
mod tests {
    use super::*;

    const KIND: &str = "numbers 1";

    fn open(path: &Path) -> (Journal, Contents<f64>) {
        Journal::open(path, KIND).expect("a journal")
    }

    #[test]
    fn records_are_read_back_bitwise() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.journal");
        let (journal, found) = open(&path);
        assert_eq!(found, Contents { records: vec![], damaged: 0 });
        for number in [0.1 + 0.2, f64::MIN_POSITIVE] {
            journal.append(&number).expect("a line");
        }
        drop(journal);
        let both = Contents { records: vec![0.1 + 0.2, f64::MIN_POSITIVE], damaged: 0 };
        assert_eq!(read(&path, KIND).expect("records"), both);
        let (journal, found) = open(&path);
        assert_eq!(found, both);
        journal.clear().expect("an empty journal");
        journal.append(&2.0).expect("a line");
        drop(journal);
        assert_eq!(open(&path).1.records, [2.0]);
    }

    /// A journal that is cut anywhere, as by a kill, loses the record that is cut and no other, before or after.
    #[test]
    fn a_torn_line_loses_only_its_record() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.journal");
        let whole = {
            let (journal, _) = open(&path);
            for number in [1.0, 2.0] {
                journal.append(&number).expect("a line");
            }
            fs::read(&path).expect("bytes")
        };
        let ends: Vec<usize> = (0..whole.len()).filter(|&at| whole[at] == b'\n').collect();
        for cut in 0..whole.len() {
            fs::write(&path, &whole[..cut]).expect("a file");
            let (journal, found) = open(&path);
            // A line may be complete without its line end.
            let kept = ends[1..].iter().filter(|&&end| cut >= end).count();
            assert_eq!(found.records, &[1.0, 2.0][..kept], "cut at {cut}");
            journal.append(&3.0).expect("a line");
            drop(journal);
            let again = open(&path).1.records;
            assert_eq!(again, [&[1.0, 2.0][..kept], &[3.0]].concat(), "cut at {cut}");
        }
    }

    #[test]
    fn second_writers_and_foreign_files_are_refused() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.journal");
        let first = open(&path).0;
        let kind_of = |path: &Path| Journal::open::<f64>(path, KIND).expect_err("refused").kind();
        assert_eq!(kind_of(&path), ErrorKind::WouldBlock);
        remove(&path, KIND);
        assert_eq!(first.path(), path);
        assert!(path.exists(), "another process writes it");
        drop(first);
        let other = folder.path().join("model.json");
        for text in ["{}", "numbers 10\n", "numbers 1", "\n"] {
            fs::write(&other, text).expect("a file");
            let opened = Journal::open::<f64>(&other, KIND);
            assert_eq!(opened.is_ok(), KIND.starts_with(text), "{text:?}");
            if opened.is_err() {
                remove(&other, KIND);
                assert_eq!(fs::read_to_string(&other).expect("text"), text);
            }
        }
        assert_eq!(kind_of(folder.path()), ErrorKind::AlreadyExists);
        assert_eq!(read::<f64>(&other, KIND).expect_err("refused").kind(), ErrorKind::AlreadyExists);
        remove(&path, KIND);
        assert!(!path.exists());
    }

    #[test]
    fn an_unserialisable_record_loses_only_itself() {
        let folder = tempfile::tempdir().expect("a folder");
        let (journal, _) = open(&folder.path().join("a.journal"));
        journal.append(&1.0).expect("a line");
        let refused = journal.append(&Unwritable).expect_err("no JSON");
        assert_eq!(refused.kind(), ErrorKind::InvalidData);
        journal.append(&2.0).expect("a line");
        let path = journal.path().to_owned();
        drop(journal);
        assert_eq!(open(&path).1, Contents { records: vec![1.0, 2.0], damaged: 0 });
    }

    struct Unwritable;

    impl Serialize for Unwritable {
        fn serialize<S: serde::Serializer>(&self, _: S) -> Result<S::Ok, S::Error> {
            Err(serde::ser::Error::custom("no"))
        }
    }

    /// This happens if a pool of processes is created while a journal is open.
    #[cfg(unix)]
    #[test]
    fn inherited_descriptors_are_unlocked() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.journal");
        let (journal, _) = open(&path);
        let inherited = journal.writing().try_clone().expect("a descriptor");
        drop(journal);
        remove(&path, KIND);
        assert!(!path.exists());
        drop(inherited);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_is_not_followed() {
        let folder = tempfile::tempdir().expect("a folder");
        let [file, link] = ["file", "link"].map(|name| folder.path().join(name));
        std::os::unix::fs::symlink(&file, &link).expect("a link");
        assert!(Journal::open::<f64>(&link, KIND).is_err());
        assert!(!file.exists());
    }
}
