//! Handling of interruptions.

use std::sync::Arc;

use anyhow::Context as _;

use crate::progress::say;
use crate::runner::records::Records;

/// Exit status of an interrupted run.
const INTERRUPTED: i32 = 130;

/// On Ctrl-C, a closed terminal or a `kill`, waits until the current line is written, reports what was saved, and exits.
///
/// If the caller has set some of these signals to be ignored, as `nohup` does, they remain ignored.
pub(super) fn stop_cleanly(records: &Arc<Records>) -> anyhow::Result<()> {
    let records = Arc::clone(records);
    let stop = move || {
        let _no_more_writes = records.writing();
        say("\nStopped. Finished data sets are saved; the same command without --fresh resumes.");
        std::process::exit(INTERRUPTED);
    };
    match ctrlc::try_set_handler(stop) {
        Err(ctrlc::Error::MultipleHandlers) => Ok(()),
        outcome => outcome.context("cannot watch for Ctrl-C"),
    }
}
