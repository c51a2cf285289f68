//! What happens when a run is stopped.

use std::sync::Arc;

use anyhow::Context as _;

use crate::progress::say;
use crate::runner::records::Records;

/// Exit status of a run that was stopped.
const INTERRUPTED: i32 = 130;

/// Ctrl-C, a closed terminal or a `kill` waits for a line that is being written, says what is kept, and leaves.
///
/// Whoever started the program may have it ignore some of these signals, as `nohup` does: then it stays with that.
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
