//! Runs the program in a folder with a recording and its model.

#![allow(dead_code, reason = "every test that has this module uses a part of it")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::OnceLock;

/// The repository's folder of examples.
pub(crate) fn examples() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/examples")
}

/// A folder with `toy.csv`, `rails.csv`, `goals.csv`, `wall.toml` and, learnt once, `toy.json`.
pub(crate) fn folder() -> &'static Path {
    static FOLDER: OnceLock<tempfile::TempDir> = OnceLock::new();
    let folder = FOLDER.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        for name in ["toy.csv", "rails.csv", "goals.csv", "wall.toml"] {
            std::fs::copy(examples().join(name), folder.path().join(name)).unwrap();
        }
        let output = command(folder.path()).args(["fit", "toy.csv", "-o", "toy.json"]).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        folder
    });
    folder.path()
}

pub(crate) fn command(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_policy-align"));
    command.current_dir(folder).stdin(Stdio::null()).env_remove("NO_COLOR").env_remove("CLICOLOR_FORCE");
    command
}

/// The result of a command line.
pub(crate) struct Ran {
    pub(crate) code: Option<i32>,
    pub(crate) out: String,
    pub(crate) err: String,
}

impl From<Output> for Ran {
    fn from(output: Output) -> Self {
        Ran {
            code: output.status.code(),
            out: String::from_utf8(output.stdout).unwrap(),
            err: String::from_utf8(output.stderr).unwrap(),
        }
    }
}

/// Runs a command line whose words are separated by spaces.
pub(crate) fn run(line: &str) -> Ran {
    run_in(folder(), line)
}

pub(crate) fn run_in(folder: &Path, line: &str) -> Ran {
    command(folder).args(line.split_whitespace()).output().unwrap().into()
}
