//! Protects against panics of other libraries on damaged files.

use std::cell::Cell;

thread_local! {
    static CATCHING: Cell<bool> = const { Cell::new(false) };
}

/// Whether a panic of this thread will be caught and become a [`ReadError`](crate::ReadError), so that a panic hook need not
/// report it.
pub fn catches_panics() -> bool {
    CATCHING.get()
}

/// The result of `read`. Libraries for containers panic on some damaged files; a panic becomes the error of a corrupt file.
#[cfg(any(feature = "parquet", feature = "hdf5", feature = "mcap", feature = "mat"))]
pub(crate) fn guarded<T>(
    file: &str,
    read: impl FnOnce() -> Result<T, crate::ReadError>,
) -> Result<T, crate::ReadError> {
    use std::panic::{AssertUnwindSafe, catch_unwind};

    use crate::{Fault, ReadError};

    let before = CATCHING.replace(true);
    let outcome = catch_unwind(AssertUnwindSafe(read));
    CATCHING.set(before);
    outcome.unwrap_or_else(|_| {
        let what = "the file contradicts itself";
        Err(ReadError::Corrupt(Fault::new(what, file, "another copy of the file, or write it again")))
    })
}

#[cfg(all(test, feature = "mcap"))]
mod tests {
    use super::*;
    use crate::ReadError;

    #[test]
    fn panics_become_errors() {
        let outcome = guarded::<()>("a.mcap", || {
            assert!(catches_panics());
            panic!("of a library")
        });
        assert!(matches!(outcome, Err(ReadError::Corrupt(_))));
        assert!(!catches_panics());
    }
}
