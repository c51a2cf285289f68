//! Regression tests: every input in `fuzz/corpus`, from fuzzing and from users' files, is read
//! again.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

#[path = "../fuzz/fuzzed/readers.rs"]
mod readers;

use std::fs;
use std::path::Path;

#[test]
fn files_are_read_or_refused() {
    for folder in ["fuzz/corpus/readers", "tests/samples"] {
        for input in fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)).unwrap() {
            readers::readers(&fs::read(input.unwrap().path()).unwrap());
        }
    }
}
