//! The report of the committed records, as the program generates it.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// The folder with report.html, generated once for all tests of a program.
pub(crate) fn report() -> &'static Path {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    FOLDER.get_or_init(|| {
        let out = Path::new(env!("CARGO_TARGET_TMPDIR")).join(env!("CARGO_CRATE_NAME"));
        // Removes the files of an earlier run.
        if out.exists() {
            std::fs::remove_dir_all(&out).unwrap();
        }
        let records = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/records/seed-1");
        let mut program = Command::new(env!("CARGO_BIN_EXE_xtask"));
        let output = program.arg("report").arg("--from").arg(records).arg("--out").arg(&out).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        out
    })
}
