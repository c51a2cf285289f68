//! Files that programs write, and where the repository keeps its own.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::Context as _;

/// The root of the repository.
pub(crate) fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Where the committed run from a seed is.
pub(crate) fn folder_of_records(seed: u64) -> PathBuf {
    repository().join(format!("docs/records/seed-{seed}"))
}

/// Writes a whole file or nothing.
pub(crate) fn write(path: &Path, contents: impl AsRef<[u8]>) -> anyhow::Result<()> {
    let mut draft = path.as_os_str().to_owned();
    draft.push(".part");
    fs::write(&draft, contents)
        .and_then(|()| fs::rename(&draft, path))
        .with_context(|| format!("cannot write {}", path.display()))
}
