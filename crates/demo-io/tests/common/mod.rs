//! Helpers for all tests of reading.

#![allow(
    dead_code,
    unreachable_pub,
    clippy::needless_pass_by_value,
    reason = "every test that has this module uses a part of it"
)]

use std::path::{Path, PathBuf};

use demo_io::{ReadError, ReadOptions, read};
use motion::Recordings;
use tempfile::TempDir;

/// A folder for the files of one test.
pub struct Files(TempDir);

impl Files {
    pub fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub fn path(&self) -> &Path {
        self.0.path()
    }

    pub fn add(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, content).unwrap();
        path
    }
}

/// Reads a file without progress.
pub fn read_with(path: &Path, options: &ReadOptions) -> Result<Recordings, ReadError> {
    read(path, options, &mut |_| ())
}

/// Reads one file with this content.
pub fn parsed(name: &str, content: impl AsRef<[u8]>, options: &ReadOptions) -> Result<Recordings, ReadError> {
    let files = Files::new();
    read_with(&files.add(name, content), options)
}

/// Checks the error of reading this content: it has three lines and contains all of `words`.
pub fn refused(name: &str, content: impl AsRef<[u8]>, options: &ReadOptions, code: &str, words: &[&str]) {
    let error = parsed(name, content, options).expect_err("should be refused");
    let text = error.to_string();
    assert_eq!(error.code(), code, "{text}");
    assert_eq!(text.lines().count(), 3, "{text}");
    for word in words {
        assert!(text.contains(word), "'{word}' is not said:\n{text}");
    }
}

/// The findings of reading, one per line.
pub fn said(recordings: &Recordings) -> String {
    let lines = recordings.findings.iter().map(|finding| format!("{}: {}", finding.what, finding.next));
    lines.collect::<Vec<_>>().join("\n")
}

/// Names of the state.
pub fn names(recordings: &Recordings) -> Vec<&str> {
    recordings.state.iter().map(|channel| &channel.name[..]).collect()
}

/// Number of samples of each episode.
pub fn lengths(recordings: &Recordings) -> Vec<usize> {
    recordings.episodes.iter().map(|episode| episode.times.len()).collect()
}
