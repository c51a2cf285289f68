//! Digests of an interrupted fit, kept next to its output.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::{fs, io};

use demo_io::FileState;
use journal::Journal;
use serde::{Deserialize, Serialize};

use crate::large::piece_digest::PieceDigest;
use crate::large::{Digester, FurtherPiece};

/// The first line of the file.
const KIND: &str = "policy-align unfinished 1";

/// Keeps digests as they are made, so that the same command resumes after an interruption.
#[derive(Debug)]
pub struct Unfinished {
    /// Sources of the further pieces that are files or parts of files, by index.
    sources: BTreeMap<usize, Source>,
    /// Digests of an earlier run.
    found: Mutex<BTreeMap<usize, PieceDigest>>,
    /// `None` after a write error, which does not make the fit fail.
    journal: Mutex<Option<Journal>>,
}

/// The inputs of a digest besides the recordings at hand: the state of the file before reading, the part of it, and its share of all rows.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Source {
    path: PathBuf,
    state: FileState,
    span: Option<Range<u64>>,
    rows: usize,
}

/// The record kept for a piece.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Record<S, D> {
    source: S,
    of: D,
}

impl Source {
    /// `None` for a folder, or if the system does not provide the file's state.
    fn of(FurtherPiece { piece, rows, .. }: &FurtherPiece) -> Option<Source> {
        let (state, path) = (FileState::of(&piece.path).ok()?, fs::canonicalize(&piece.path).ok()?);
        let span = piece.span.as_ref().map(|span| span.bytes.clone());
        Some(Source { path, state, span, rows: *rows })
    }
}

impl Unfinished {
    /// Path for the digests of the fit or part that writes `output`: `output.unfinished`.
    pub fn beside(output: &Path) -> PathBuf {
        let mut path = output.as_os_str().to_owned();
        path.push(".unfinished");
        PathBuf::from(path)
    }

    /// Opens this file for digests of these pieces. Digests from an earlier run are reused if they were made for the same recordings at
    /// hand, options and version, and the files that were read have not changed.
    ///
    /// # Errors
    /// If the file cannot be written, another process is writing it, or it is of another kind.
    pub fn open(path: &Path, pieces: &[FurtherPiece], digester: &Digester) -> io::Result<Unfinished> {
        let (journal, kept) = Journal::open::<Record<Source, PieceDigest>>(path, KIND)?;
        let source = |piece: &FurtherPiece| Some((piece.at, Source::of(piece)?));
        let sources: BTreeMap<usize, Source> = pieces.iter().filter_map(source).collect();
        let is_of = |Record { source, of }: &Record<Source, PieceDigest>| {
            sources.get(&of.at) == Some(source) && of.digest.made_for == digester.made_for()
        };
        let found: BTreeMap<usize, PieceDigest> =
            kept.records.into_iter().filter(is_of).map(|Record { of, .. }| (of.at, of)).collect();
        if found.is_empty() {
            journal.clear()?;
        }
        Ok(Unfinished { sources, found: Mutex::new(found), journal: Mutex::new(Some(journal)) })
    }

    /// Number of an earlier run's digests that have not been taken yet.
    pub fn remaining(&self) -> usize {
        self.found.lock().map_or(0, |found| found.len())
    }

    /// Takes the digest of this piece from an earlier run.
    pub(super) fn take(&self, piece: &FurtherPiece) -> Option<PieceDigest> {
        self.found.lock().ok()?.remove(&piece.at)
    }

    /// Keeps a digest, except that of a folder.
    pub(super) fn keep(&self, digest: &PieceDigest) {
        let is_full = |journal: &mut Journal, source: &Source| {
            let failed = journal.append(&Record { source, of: digest }).err();
            // A path that is not valid text is not kept.
            failed.is_some_and(|error| error.kind() != io::ErrorKind::InvalidData)
        };
        if let Some(source) = self.sources.get(&digest.at)
            && let Ok(mut journal) = self.journal.lock()
            && let Some(full) = journal.take_if(|journal| is_full(journal, source))
        {
            // Frees the space for the model.
            let _ = fs::remove_file(full.path());
        }
    }

    /// Removes such a file when it is no longer needed and no process writes it.
    pub fn remove(path: &Path) {
        journal::remove(path, KIND);
    }
}
