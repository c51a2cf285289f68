//! Episodes of several files as one set.

use crate::raw::RawRecordings;
use crate::{Fault, ReadError};

/// Appends the episodes of another file.
pub(crate) fn add(joined: &mut Option<RawRecordings>, more: RawRecordings, file: &str) -> Result<(), ReadError> {
    let Some(joined) = joined else {
        *joined = Some(more);
        return Ok(());
    };
    if joined.channels != more.channels {
        let what = format!("channels differ: {} here, {} before", more.names().join(", "), joined.names().join(", "));
        let remedy = "--state with channels that all files have, or files of one kind";
        return Err(ReadError::Lengths(Fault::new(what, file, remedy)));
    }
    let recorded = |drafts: &RawRecordings| drafts.episodes.iter().any(|draft| !draft.velocities.is_empty());
    if recorded(joined) != recorded(&more) {
        let what = "velocities are recorded in some of the files only";
        let remedy = "--ignore with the names of the velocities, or files of one kind";
        return Err(ReadError::Lengths(Fault::new(what, file, remedy)));
    }
    joined.episodes.extend(more.episodes);
    for finding in more.findings {
        // Every file says the same of its columns.
        if !joined.findings.contains(&finding) {
            joined.findings.push(finding);
        }
    }
    Ok(())
}
