//! Digests of a fit that was interrupted, kept beside what it was to write.

use std::collections::BTreeMap;
use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, BufRead as _, BufReader, Read as _, Write as _};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use demo_io::FileState;
use serde::{Deserialize, Serialize};

use crate::large::piece_digest::PieceDigest;
use crate::large::{Digester, FurtherPiece};
use crate::stored::sha256;

/// First line.
const HEADER: &str = "policy-align unfinished 1";

/// Digests that are kept as they are made, so that the same command goes on where it was interrupted: a line each, a checksum and JSON.
#[derive(Debug)]
pub struct Unfinished {
    path: PathBuf,
    /// Of an earlier run, by place among the further pieces.
    found: Mutex<BTreeMap<usize, PieceDigest>>,
    /// None once nothing can be written any more: a fit does not fail for that.
    file: Mutex<Option<File>>,
}

/// What a digest depends on beside the recordings at hand: the file as it was before it was read, the part of it, and its share of all rows.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Source {
    path: PathBuf,
    state: FileState,
    part: Option<Range<u64>>,
    rows: usize,
}

/// What a line says behind its checksum.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Line<S, D> {
    source: S,
    of: D,
}

impl Source {
    /// None for a folder, or if the system does not tell.
    pub(super) fn of(FurtherPiece { piece, rows, .. }: &FurtherPiece) -> Option<Source> {
        let (state, path) = (FileState::of(&piece.path).ok()?, fs::canonicalize(&piece.path).ok()?);
        let part = piece.span.as_ref().map(|span| span.bytes.clone());
        Some(Source { path, state, part, rows: *rows })
    }
}

impl Unfinished {
    /// Where digests are kept of the fit or part that is written to `output`: `output.unfinished`.
    pub fn beside(output: &Path) -> PathBuf {
        let mut path = output.as_os_str().to_owned();
        path.push(".unfinished");
        PathBuf::from(path)
    }

    /// For digests of these pieces. Those that an earlier run kept are found again if they were made for the same recordings at hand, options and
    /// version, and the file has not changed.
    ///
    /// # Errors
    /// If nothing can be written there, or the file is none of these.
    pub fn open(output: &Path, pieces: &[FurtherPiece], digester: &Digester) -> io::Result<Unfinished> {
        let path = Self::beside(output);
        let exists = match fs::symlink_metadata(&path) {
            Ok(found) if is_own(&path, &found) => true,
            Ok(_) => return Err(io::Error::new(io::ErrorKind::AlreadyExists, "it exists and is not of a fit")),
            Err(_) => false,
        };
        let found = if exists { read(&path, pieces, digester).unwrap_or_default() } else { BTreeMap::new() };
        let mut file = OpenOptions::new().append(true).create_new(!exists).open(&path)?;
        if found.is_empty() {
            file.set_len(0)?;
            writeln!(file, "{HEADER}")?;
        } else {
            // Ends a line that an interrupt cut.
            writeln!(file)?;
        }
        Ok(Unfinished { path, found: Mutex::new(found), file: Mutex::new(Some(file)) })
    }

    /// Digests of an earlier run that have not been taken yet.
    pub fn remaining(&self) -> usize {
        self.found.lock().map_or(0, |found| found.len())
    }

    /// The digest of an earlier run.
    pub(super) fn take(&self, piece: &FurtherPiece) -> Option<PieceDigest> {
        self.found.lock().ok()?.remove(&piece.at)
    }

    /// Keeps a digest, of a file as it was before it was read.
    pub(super) fn keep(&self, source: &Source, digest: &PieceDigest) {
        if let Ok(json) = serde_json::to_string(&Line { source, of: digest })
            && let Ok(mut file) = self.file.lock()
        {
            let line = format!("{} {json}\n", sha256(json.as_bytes()));
            if file.as_mut().is_some_and(|file| file.write_all(line.as_bytes()).is_err()) {
                *file = None;
                // The model needs the room.
                let _ = fs::remove_file(&self.path);
            }
        }
    }

    /// Removes what is kept for `output`, once that is written.
    pub fn remove(output: &Path) {
        let path = Self::beside(output);
        if fs::symlink_metadata(&path).is_ok_and(|found| is_own(&path, &found)) {
            // Without it there is nothing to remove.
            let _ = fs::remove_file(path);
        }
    }
}

/// Whether it was made here.
fn is_own(path: &Path, found: &Metadata) -> bool {
    let first = || BufReader::new(File::open(path).ok()?.take(HEADER.len() as u64)).lines().next()?.ok();
    found.is_file() && (found.len() == 0 || first().is_some_and(|first| first == HEADER))
}

fn read(path: &Path, pieces: &[FurtherPiece], digester: &Digester) -> io::Result<BTreeMap<usize, PieceDigest>> {
    let source = |piece: &FurtherPiece| Some((piece.at, Source::of(piece)?));
    let sources: BTreeMap<usize, Source> = pieces.iter().filter_map(source).collect();
    let mut found = BTreeMap::new();
    for line in BufReader::new(File::open(path)?).split(b'\n') {
        // A line that was cut may end within a letter.
        if let Ok(line) = String::from_utf8(line?)
            && let Some((checksum, json)) = line.split_once(' ')
            && checksum == sha256(json.as_bytes())
            && let Ok(Line::<Source, PieceDigest> { source, of }) = serde_json::from_str(json)
            && sources.get(&of.at) == Some(&source)
            && of.digest.made_for == digester.made_for()
        {
            found.insert(of.at, of);
        }
    }
    Ok(found)
}
