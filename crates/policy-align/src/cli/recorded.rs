//! Recordings of the files that a command names.

use std::path::{Path, PathBuf};

use motion::{Finding, Recordings};
use policy_align::FileSummary;

use crate::cli::failure::{Failure, displayed};
use crate::cli::lines::counted;
use crate::cli::options::flags::ReadFlags;
use crate::cli::session::Session;

/// Warnings that are printed: a recorder that repeats itself would fill the screen.
const PRINTED: usize = 6;

/// Reads them, with a bar if it takes long; warns of what was found meanwhile.
pub(crate) fn read(session: &Session, files: &[PathBuf], flags: &ReadFlags) -> Result<Recordings, Failure> {
    let bytes = files.iter().filter_map(|file| std::fs::metadata(file).ok()).map(|found| found.len()).sum();
    let bar = session.bar(bytes, "reading  {bar:30} {bytes} of {total_bytes}, {eta} left");
    let recordings = demo_io::read_all(files, &flags.options()?, &mut |read| bar.inc(read));
    bar.finish_and_clear();
    let mut recordings = recordings?;
    warn(session, &recordings.findings);
    if flags.trim_still {
        prepare::trim_still(&mut recordings);
    }
    Ok(recordings)
}

fn warn(session: &Session, findings: &[Finding]) {
    for finding in findings.iter().take(PRINTED) {
        session.warn(&format!("{}: {}", finding.what, finding.next));
    }
    if findings.len() > PRINTED {
        session.warn(&format!("and {} more: check --json lists all", findings.len() - PRINTED));
    }
}

/// Findings other than those that reading has printed already.
pub(crate) fn unreported(findings: &[Finding], recordings: &Recordings) -> Vec<Finding> {
    findings.iter().filter(|finding| !recordings.findings.contains(finding)).cloned().collect()
}

/// Names and checksums, for the model.
pub(crate) fn summaries(files: &[PathBuf]) -> Result<Vec<FileSummary>, Failure> {
    let summary = |path: &PathBuf| FileSummary::of(path).map_err(|error| Failure::reading(path, error));
    // Of a folder its files are read, but not listed one by one.
    files.iter().filter(|path| path.is_file()).map(summary).collect()
}

/// Without folders: a model does not tell where it was made.
pub(crate) fn base_name(path: &Path) -> String {
    path.file_name().map_or_else(|| displayed(path), |name| name.to_string_lossy().into_owned())
}

/// The files in a few words.
pub(crate) fn named(files: &[PathBuf]) -> String {
    match files {
        [file] => base_name(file),
        files => counted(files.len(), "file"),
    }
}
