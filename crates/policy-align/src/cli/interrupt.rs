//! Ctrl-C, and what ends a program otherwise.

use std::process::exit;
#[cfg(feature = "ros2")]
use std::sync::atomic::{AtomicBool, Ordering};

use crate::cli::failure::Exit;

/// Whether a command ends by itself when it is interrupted, and whether it was.
#[cfg(feature = "ros2")]
static AWAITED: AtomicBool = AtomicBool::new(false);
#[cfg(feature = "ros2")]
static HEARD: AtomicBool = AtomicBool::new(false);

/// Ends the program at once, but for a command that waits for the interrupt; a second one ends that too. Files are written whole or not
/// at all.
pub(crate) fn interrupt() {
    #[cfg(feature = "ros2")]
    if AWAITED.load(Ordering::SeqCst) && !HEARD.swap(true, Ordering::SeqCst) {
        return;
    }
    demo_io::abandon_drafts();
    exit(Exit::Interrupted as i32)
}

/// From now on an interrupt does not end the program: the command looks for it.
#[cfg(feature = "ros2")]
pub(crate) fn await_interrupt() {
    AWAITED.store(true, Ordering::SeqCst);
}

/// Whether there was one since.
#[cfg(feature = "ros2")]
pub(crate) fn interrupted() -> bool {
    HEARD.load(Ordering::SeqCst)
}
