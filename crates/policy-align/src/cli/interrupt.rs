//! Ctrl-C and other signals that end the program.

use std::process::exit;
use std::sync::Mutex;
#[cfg(feature = "ros2")]
use std::sync::atomic::{AtomicBool, Ordering};

use crate::cli::failure::Exit;
use crate::cli::session::complain;

/// Message that is printed before an interrupt ends the program.
static LAST_WORDS: Mutex<Option<String>> = Mutex::new(None);

/// Whether a command handles an interrupt itself, and whether one has occurred.
#[cfg(feature = "ros2")]
static AWAITED: AtomicBool = AtomicBool::new(false);
#[cfg(feature = "ros2")]
static HEARD: AtomicBool = AtomicBool::new(false);

/// Ends the program at once, unless a command waits for the interrupt; a second interrupt ends that command too. Files are written
/// completely or not at all.
pub(crate) fn interrupt() {
    #[cfg(feature = "ros2")]
    if AWAITED.load(Ordering::SeqCst) && !HEARD.swap(true, Ordering::SeqCst) {
        return;
    }
    demo_io::abandon_drafts();
    if let Ok(Some(words)) = LAST_WORDS.lock().as_deref() {
        complain(&format!("\n{words}"));
    }
    exit(Exit::Interrupted as i32)
}

/// Sets the message that is printed if an interrupt ends the program; `None` prints nothing.
pub(crate) fn last_words(words: Option<String>) {
    if let Ok(mut last) = LAST_WORDS.lock() {
        *last = words;
    }
}

/// From now on an interrupt does not end the program; the command polls for it.
#[cfg(feature = "ros2")]
pub(crate) fn await_interrupt() {
    AWAITED.store(true, Ordering::SeqCst);
}

/// Whether an interrupt has occurred since.
#[cfg(feature = "ros2")]
pub(crate) fn interrupted() -> bool {
    HEARD.load(Ordering::SeqCst)
}
