//! Files in pieces of whole movements.

use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::input::name_of;
use crate::regular_file::FileState;
use crate::{Fault, ReadError};

/// A file to read, or a part of one.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Piece {
    /// Where the file is.
    pub path: PathBuf,
    /// Whether movements carry the name of the file, since it is one of several: `monday/3`.
    pub named_by_file: bool,
    /// Which part; none if all of it.
    pub span: Option<Span>,
}

/// Records of a text that are whole movements.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Span {
    /// Which of the file's parts it is, counted from 0.
    pub number: usize,
    /// Its bytes.
    pub bytes: Range<u64>,
    /// Where it begins, counted from 1.
    pub line: u64,
    /// Movements before it.
    pub movements: usize,
    /// The file when it was cut.
    pub of: FileState,
}

impl Piece {
    /// All of a file or folder.
    pub fn whole(path: impl Into<PathBuf>, named_by_file: bool) -> Piece {
        Piece { path: path.into(), named_by_file, span: None }
    }

    /// Whether the file begins with it, so that one of its pieces does.
    pub fn is_first(&self) -> bool {
        self.span.as_ref().is_none_or(|span| span.number == 0)
    }

    /// How many bytes it has: of a part, of a file, or of all files in a folder.
    pub fn bytes(&self) -> u64 {
        self.span.as_ref().map_or_else(|| bytes_of(&self.path), Span::size)
    }

    /// What messages call it: the file without folders, and where a part begins.
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

/// How many bytes a file has, or all files in a folder; 0 if it cannot be read, which the reader complains of.
pub fn bytes_of(path: &Path) -> u64 {
    match fs::metadata(path) {
        Ok(found) if found.is_dir() => {
            let entries = fs::read_dir(path).into_iter().flatten().flatten();
            // Links to folders may lead round in a circle.
            let is_link = |entry: &fs::DirEntry| entry.file_type().is_ok_and(|kind| kind.is_symlink());
            let inside = entries.filter(|entry| !is_link(entry) || entry.path().is_file());
            inside.map(|entry| bytes_of(&entry.path())).sum()
        }
        Ok(found) => found.len(),
        Err(_) => 0,
    }
}

impl Span {
    /// How many bytes it has.
    pub fn size(&self) -> u64 {
        self.bytes.end.saturating_sub(self.bytes.start)
    }

    /// Refuses a file that is no longer as it was when it was cut.
    pub(crate) fn require_unchanged(&self, path: &Path) -> Result<(), ReadError> {
        if FileState::of(path).is_ok_and(|now| now == self.of) {
            return Ok(());
        }
        let remedy = "the same command again, once nothing writes to the file, with the same file for all workers";
        Err(ReadError::Corrupt(Fault::new("the file has changed while it was read", name_of(path), remedy)))
    }
}

/// Where a movement begins.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Start {
    pub(crate) byte: u64,
    pub(crate) line: u64,
    /// Movements before it.
    pub(crate) movements: usize,
}

/// Cuts a file where movements begin.
#[derive(Debug)]
pub(crate) struct Cuts {
    most: u64,
    of: FileState,
    spans: Vec<Span>,
    /// Of the part that has not been closed, and of its last movement.
    begun: Option<(Start, Start)>,
}

impl Cuts {
    /// Into parts of at most so many bytes, unless a movement has more.
    pub(crate) fn new(most: u64, of: FileState) -> Cuts {
        Cuts { most, of, spans: Vec::new(), begun: None }
    }

    /// The next movement begins here.
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

    /// The parts of a file that ends where it ended when it was opened.
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
