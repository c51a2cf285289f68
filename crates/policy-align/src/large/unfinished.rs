//! Digests of a fit that was interrupted, kept beside what it was to write.

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

/// Digests that are kept as they are made, so that the same command goes on where it was interrupted.
#[derive(Debug)]
pub struct Unfinished {
    /// Of every further piece that is a file or a part of one, by its place.
    sources: BTreeMap<usize, Source>,
    /// Of an earlier run.
    found: Mutex<BTreeMap<usize, PieceDigest>>,
    /// None once nothing can be written any more: a fit does not fail for that.
    journal: Mutex<Option<Journal>>,
}

/// What a digest depends on beside the recordings at hand: the file as it was before anything was read, the part of it, and its share of
/// all rows.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Source {
    path: PathBuf,
    state: FileState,
    span: Option<Range<u64>>,
    rows: usize,
}

/// What is kept of a piece.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Record<S, D> {
    source: S,
    of: D,
}

impl Source {
    /// None for a folder, or if the system does not tell.
    fn of(FurtherPiece { piece, rows, .. }: &FurtherPiece) -> Option<Source> {
        let (state, path) = (FileState::of(&piece.path).ok()?, fs::canonicalize(&piece.path).ok()?);
        let span = piece.span.as_ref().map(|span| span.bytes.clone());
        Some(Source { path, state, span, rows: *rows })
    }
}

impl Unfinished {
    /// Where digests are kept of the fit or part that is written to `output`: `output.unfinished`.
    pub fn beside(output: &Path) -> PathBuf {
        let mut path = output.as_os_str().to_owned();
        path.push(".unfinished");
        PathBuf::from(path)
    }

    /// For digests of these pieces, in this file. Those that an earlier run kept are found again if they were made for the same recordings at
    /// hand, options and version, and the file that was read has not changed.
    ///
    /// # Errors
    /// If nothing can be written there, another process does, or the file is none of these.
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

    /// Digests of an earlier run that have not been taken yet.
    pub fn remaining(&self) -> usize {
        self.found.lock().map_or(0, |found| found.len())
    }

    /// The digest of an earlier run.
    pub(super) fn take(&self, piece: &FurtherPiece) -> Option<PieceDigest> {
        self.found.lock().ok()?.remove(&piece.at)
    }

    /// Keeps a digest; of a folder none is kept.
    pub(super) fn keep(&self, digest: &PieceDigest) {
        let is_full = |journal: &mut Journal, source: &Source| {
            let failed = journal.append(&Record { source, of: digest }).err();
            // A path that is no text is not kept.
            failed.is_some_and(|error| error.kind() != io::ErrorKind::InvalidData)
        };
        if let Some(source) = self.sources.get(&digest.at)
            && let Ok(mut journal) = self.journal.lock()
            && let Some(full) = journal.take_if(|journal| is_full(journal, source))
        {
            // The model needs the room.
            let _ = fs::remove_file(full.path());
        }
    }

    /// Removes such a file, once it is not needed and nothing keeps digests there any more.
    pub fn remove(path: &Path) {
        journal::remove(path, KIND);
    }
}
