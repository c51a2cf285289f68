//! Digests of a fit that was interrupted, kept beside what it was to write.

use std::collections::BTreeMap;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufRead as _, BufReader, Write as _};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::SystemTime;

use serde::{Deserialize, Serialize};

use crate::large::file_digest::FileDigest;
use crate::large::{Digester, FurtherFile};

/// Digests that are kept as they are made, a line of JSON for each, so that the same command goes on where it was interrupted.
#[derive(Debug)]
pub struct Unfinished {
    path: PathBuf,
    /// Of an earlier run, by place among the further files.
    found: Mutex<BTreeMap<usize, Kept>>,
    /// None if nothing can be written: a fit does not fail for that.
    file: Mutex<Option<File>>,
}

/// A line.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Kept {
    /// When the file had been changed last before it was read.
    modified: SystemTime,
    of: FileDigest,
}

impl Unfinished {
    /// Of the fit or part that is written to `output`: in the file `output.unfinished`. Digests of an earlier run are found again if they were
    /// made for the same recordings at hand and the same options; a line that was not ended is none.
    pub fn of(output: &Path, digester: &Digester) -> Unfinished {
        let mut path = output.as_os_str().to_owned();
        path.push(".unfinished");
        let path = PathBuf::from(path);
        let found = read(&path, digester).unwrap_or_default();
        let mut options = OpenOptions::new();
        let options = if found.is_empty() { options.write(true).truncate(true) } else { options.append(true) };
        // Ends a line that an interrupt cut.
        let begun = options.create(true).open(&path).and_then(|mut file| file.write_all(b"\n").map(|()| file));
        Unfinished { path, found: Mutex::new(found), file: Mutex::new(begun.ok()) }
    }

    /// Digests of an earlier run that were not asked for yet.
    pub fn found(&self) -> usize {
        self.found.lock().map_or(0, |found| found.len())
    }

    /// The digest of an earlier run if the file has not changed since; otherwise what `make` makes, which is kept.
    pub(super) fn or_make<E>(
        &self,
        file: &FurtherFile,
        make: impl FnOnce() -> Result<FileDigest, E>,
    ) -> Result<FileDigest, E> {
        let modified = fs::metadata(&file.path).ok().filter(fs::Metadata::is_file).and_then(|of| of.modified().ok());
        let found = self.found.lock().ok().and_then(|mut found| found.remove(&file.at));
        if let Some(Kept { modified: before, of }) = found
            && Some(before) == modified
            && (of.bytes, &of.name) == (file.bytes, &file.name())
        {
            return Ok(of);
        }
        let mut of = make()?;
        if let Some(modified) = modified {
            of = self.keep(Kept { modified, of });
        }
        Ok(of)
    }

    fn keep(&self, kept: Kept) -> FileDigest {
        if let Ok(mut line) = serde_json::to_vec(&kept)
            && let Ok(mut file) = self.file.lock()
        {
            line.push(b'\n');
            if file.as_mut().is_some_and(|file| file.write_all(&line).is_err()) {
                *file = None;
            }
        }
        kept.of
    }

    /// Removes the file, once what it was for is written.
    pub fn finished(self) {
        drop(self.file);
        // Without it there is nothing to remove.
        let _ = fs::remove_file(self.path);
    }
}

fn read(path: &Path, digester: &Digester) -> io::Result<BTreeMap<usize, Kept>> {
    let mut found = BTreeMap::new();
    for line in BufReader::new(File::open(path)?).split(b'\n') {
        if let Ok(kept) = serde_json::from_slice::<Kept>(&line?)
            && kept.of.digest.made_for == digester.made_for()
        {
            found.insert(kept.of.at, kept);
        }
    }
    Ok(found)
}
