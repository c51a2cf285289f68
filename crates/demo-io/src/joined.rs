//! Joins the episodes of several files to one set.

use std::path::Path;

use crate::input::name_of;
use crate::raw::RawRecordings;
use crate::{Fault, ReadError};

/// Joins the results of `read` for files or pieces of files, in their order; `None` without a file.
pub(crate) fn joined<P: AsRef<Path>>(
    files: &[P],
    mut read: impl FnMut(&P) -> Result<RawRecordings, ReadError>,
) -> Result<Option<RawRecordings>, ReadError> {
    let mut joined: Option<RawRecordings> = None;
    let mut last: Option<&Path> = None;
    for file in files {
        let (more, path) = (read(file)?, file.as_ref());
        match &mut joined {
            Some(joined) => join(joined, more, &name_of(path), last == Some(path))?,
            None => joined = Some(more),
        }
        last = Some(path);
    }
    Ok(joined)
}

/// Appends the episodes of another file, or of another piece of the last one.
fn join(joined: &mut RawRecordings, mut more: RawRecordings, file: &str, is_last: bool) -> Result<(), ReadError> {
    more.order_as(&joined.channels);
    if joined.channels != more.channels {
        let what = format!("channels differ: {} here, {} before", more.names().join(", "), joined.names().join(", "));
        let remedy = "--state with channels that all files have, or files of one kind";
        return Err(ReadError::Lengths(Fault::new(what, file, remedy)));
    }
    let recorded = |recordings: &RawRecordings| recordings.episodes.iter().any(|raw| !raw.velocities.is_empty());
    if !is_last && recorded(joined) != recorded(&more) {
        let what = "velocities are recorded in some of the files only";
        let remedy = "--ignore with the names of the velocities, or files of one kind";
        return Err(ReadError::Lengths(Fault::new(what, file, remedy)));
    }
    joined.episodes.extend(more.episodes);
    // A pattern is unknown only if no file matches it.
    joined.unknown.patterns.retain(|pattern| more.unknown.patterns.contains(pattern));
    for finding in more.findings {
        // Every file yields the same findings about its columns.
        if !joined.findings.contains(&finding) {
            joined.findings.push(finding);
        }
    }
    Ok(())
}
