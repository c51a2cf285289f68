use std::sync::atomic::{AtomicBool, Ordering};

use crate::FitError;

/// Progress of a fit, and its cancellation.
pub struct Progress<'a> {
    /// Flag that cancels the fit; checked between steps.
    pub cancelled: &'a AtomicBool,
    /// Called at the beginning of every step.
    pub report: &'a mut dyn FnMut(Step),
}

/// A step of a fit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Step {
    /// Number of completed steps.
    pub done: usize,
    /// Total number of steps.
    pub of: usize,
    /// Description of the step that begins.
    pub what: &'static str,
}

impl Progress<'_> {
    pub(super) fn begin(&mut self, done: usize, of: usize, what: &'static str) -> Result<(), FitError> {
        if self.is_cancelled() {
            return Err(FitError::Cancelled);
        }
        (self.report)(Step { done, of, what });
        Ok(())
    }

    pub(super) fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }
}
