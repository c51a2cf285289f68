//! Recordings of the files that a command names.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use demo_io::{Note, NoteKind, ReadOptions, Recordings};
use policy_align::FileSummary;

use super::failure::{Failure, shown};
use super::lines::counted;
use super::session::Session;

/// Warnings of a kind that are shown: a recorder that repeats itself would fill the screen.
const SHOWN: usize = 3;

/// Reads them, with a bar if it takes long; says what was noticed.
pub(crate) fn read(session: &Session, files: &[PathBuf], options: &ReadOptions) -> Result<Recordings, Failure> {
    let bytes = files.iter().filter_map(|file| std::fs::metadata(file).ok()).map(|found| found.len()).sum();
    let bar = session.bar(bytes, "reading  {bar:30} {bytes} of {total_bytes}, {eta} left");
    let recordings = demo_io::read_all(files, options, &mut |read| bar.inc(read));
    bar.finish_and_clear();
    let recordings = recordings?;
    warn(session, &recordings.notes);
    Ok(recordings)
}

/// Says what was noticed, kind by kind.
fn warn(session: &Session, notes: &[Note]) {
    let mut by_kind: BTreeMap<NoteKind, Vec<&Note>> = BTreeMap::new();
    for note in notes {
        by_kind.entry(note.kind).or_default().push(note);
    }
    for notes in by_kind.values() {
        for note in notes.iter().take(SHOWN) {
            session.warn(&note.text);
        }
        if notes.len() > SHOWN {
            session.warn(&format!("and {} more of this kind: check --html lists all", notes.len() - SHOWN));
        }
    }
}

/// Names and checksums, for the model.
pub(crate) fn summaries(files: &[PathBuf]) -> Result<Vec<FileSummary>, Failure> {
    let summary = |path: &PathBuf| FileSummary::of(path).map_err(|error| Failure::reading(path, error));
    // Of a folder its files are read, but not listed one by one.
    files.iter().filter(|path| path.is_file()).map(summary).collect()
}

/// Without folders: a model does not tell where it was made.
pub(crate) fn base_name(path: &Path) -> String {
    path.file_name().map_or_else(|| shown(path), |name| name.to_string_lossy().into_owned())
}

/// The files in a few words.
pub(crate) fn named(files: &[PathBuf]) -> String {
    match files {
        [file] => base_name(file),
        files => counted(files.len(), "file"),
    }
}
