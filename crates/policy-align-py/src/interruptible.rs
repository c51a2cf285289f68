use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

/// Interval between two checks for signals.
const LOOK: Duration = Duration::from_millis(50);

/// Runs slow work without the interpreter's lock. Ctrl-C raises an exception at once and sets the flag, which asks the
/// work to end because its result is no longer needed.
pub(crate) fn interruptible<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(&AtomicBool) -> T + Send + 'static,
) -> PyResult<T> {
    let cancelled = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&cancelled);
    let (done, mut result) = channel();
    let work = move || {
        // After an interrupt, the receiver no longer exists.
        let _ = done.send(catch_unwind(AssertUnwindSafe(|| work(&flag))));
    };
    thread::Builder::new().spawn(work)?;
    loop {
        let came;
        (came, result) = py.detach(move || (result.recv_timeout(LOOK), result));
        match came {
            Ok(Ok(value)) => return Ok(value),
            Ok(Err(panic)) => resume_unwind(panic),
            Err(RecvTimeoutError::Timeout) => py.check_signals().inspect_err(|_| {
                cancelled.store(true, Ordering::Relaxed);
            })?,
            Err(RecvTimeoutError::Disconnected) => return Err(PyRuntimeError::new_err("the computation is gone")),
        }
    }
}
