//! Pieces of files that consist of whole movements.

use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::input::name_of;
use crate::regular_file::FileState;
use crate::{Fault, ReadError};

/// A file, or a part of one, to read.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Piece {
    /// Path of the file.
    pub path: PathBuf,
    /// Whether the names of movements contain that of the file, because it is one of several: `monday/3`.
    pub named_by_file: bool,
    /// The part; `None` for the whole file.
    pub span: Option<Span>,
}

/// Records of a text that form whole movements.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Span {
    /// Number of the part within the file, counted from 0.
    pub number: usize,
    /// Its byte range.
    pub bytes: Range<u64>,
    /// Its first line, counted from 1.
    pub line: u64,
    /// Number of movements before it.
    pub movements: usize,
    /// State of the file when it was cut.
    pub of: FileState,
}

impl Piece {
    /// The whole of a file or folder.
    pub fn whole(path: impl Into<PathBuf>, named_by_file: bool) -> Piece {
        Piece { path: path.into(), named_by_file, span: None }
    }

    /// Whether the piece is the beginning of the file.
    pub fn is_first(&self) -> bool {
        self.span.as_ref().is_none_or(|span| span.number == 0)
    }

    /// Size in bytes of a part, of a file, or of all files in a folder.
    pub fn bytes(&self) -> u64 {
        self.span.as_ref().map_or_else(|| bytes_of(&self.path), Span::size)
    }

    /// Name in messages: the file without folders, and the first line of a part.
    pub fn name(&self) -> String {
        let name = name_of(&self.path);
        self.span.as_ref().map_or(name.clone(), |span| format!("{name} from line {}", span.line))
    }
}

impl AsRef<Path> for Piece {
    fn as_ref(&self) -> &Path {
        &self.path
    }
}

/// Size in bytes of a file, or of all files in a folder; 0 if it cannot be read, which the reader will report.
pub fn bytes_of(path: &Path) -> u64 {
    match fs::metadata(path) {
        Ok(found) if found.is_dir() => {
            let entries = fs::read_dir(path).into_iter().flatten().flatten();
            // Links to folders may form a cycle.
            let is_link = |entry: &fs::DirEntry| entry.file_type().is_ok_and(|kind| kind.is_symlink());
            let inside = entries.filter(|entry| !is_link(entry) || entry.path().is_file());
            inside.map(|entry| bytes_of(&entry.path())).sum()
        }
        Ok(found) => found.len(),
        Err(_) => 0,
    }
}

impl Span {
    /// Size in bytes.
    pub fn size(&self) -> u64 {
        self.bytes.end.saturating_sub(self.bytes.start)
    }

    /// Refuses a file that has changed since it was cut.
    pub(crate) fn require_unchanged(&self, path: &Path) -> Result<(), ReadError> {
        if FileState::of(path).is_ok_and(|now| now == self.of) {
            return Ok(());
        }
        let remedy = "the same command again, once nothing writes to the file, with the same file for all workers";
        Err(ReadError::Corrupt(Fault::new("the file has changed while it was read", name_of(path), remedy)))
    }
}

/// The beginning of a movement.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Start {
    pub(crate) byte: u64,
    pub(crate) line: u64,
    /// Number of movements before it.
    pub(crate) movements: usize,
}

/// Cuts a file at the beginnings of movements.
#[derive(Debug)]
pub(crate) struct Cuts {
    most: u64,
    of: FileState,
    spans: Vec<Span>,
    /// The beginnings of the open part and of its last movement.
    begun: Option<(Start, Start)>,
}

impl Cuts {
    /// Cuts into parts of at most `most` bytes, unless a movement has more.
    pub(crate) fn new(most: u64, of: FileState) -> Cuts {
        Cuts { most, of, spans: Vec::new(), begun: None }
    }

    /// Adds the beginning of the next movement.
    pub(crate) fn push(&mut self, here: Start) {
        let (first, last) = self.begun.unwrap_or((here, here));
        let is_full = here.byte - first.byte > self.most && last.byte > first.byte;
        if is_full {
            self.close(first, last.byte);
        }
        self.begun = Some((if is_full { last } else { first }, here));
    }

    fn close(&mut self, Start { byte, line, movements }: Start, end: u64) {
        self.spans.push(Span { number: self.spans.len(), bytes: byte..end, line, movements, of: self.of.clone() });
    }

    /// The parts of the file, which ends where it ended when it was opened.
    pub(crate) fn finish(mut self) -> Vec<Span> {
        let Some((_, last)) = self.begun else { return Vec::new() };
        let end = self.of.bytes.max(last.byte);
        self.push(Start { byte: end, ..last });
        if let Some((first, _)) = self.begun {
            self.close(first, end);
        }
        self.spans
    }
}
