//! Episodes of several files as one set.

use crate::raw::RawRecordings;
use crate::{Fault, ReadError};

pub(crate) fn add(joined: &mut Option<RawRecordings>, drafts: RawRecordings, file: &str) -> Result<(), ReadError> {
    if let Some(joined) = joined {
        join(joined, drafts, file)
    } else {
        *joined = Some(drafts);
        Ok(())
    }
}

/// Appends the episodes of another file.
fn join(joined: &mut RawRecordings, more: RawRecordings, file: &str) -> Result<(), ReadError> {
    let names = |drafts: &RawRecordings| drafts.channels.iter().map(|channel| channel.name.clone()).collect::<Vec<_>>();
    if joined.channels != more.channels {
        let what = format!("channels differ: {} here, {} before", names(&more).join(", "), names(joined).join(", "));
        return Err(ReadError::Lengths(Fault::new(
            what,
            file,
            "--state with channels that all files have, or files of one kind",
        )));
    }
    let recorded = |drafts: &RawRecordings| drafts.episodes.iter().any(|draft| !draft.velocities.is_empty());
    if recorded(joined) != recorded(&more) {
        let what = "velocities are recorded in some of the files only";
        return Err(ReadError::Lengths(Fault::new(
            what,
            file,
            "--ignore with the names of the velocities, or files of one kind",
        )));
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
