//! Runs every input of `fuzz/corpus`, found by fuzzing or written by hand. The program's configuration is tested in its
//! module.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

#[path = "../fuzz/fuzzed/constraint_file.rs"]
mod constraint_file;
#[path = "../fuzz/fuzzed/model_file.rs"]
mod model_file;

use std::fs;
use std::path::Path;

fn corpus(target: &str) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus").join(target);
    let inputs: Vec<Vec<u8>> =
        fs::read_dir(folder).unwrap().map(|entry| fs::read(entry.unwrap().path()).unwrap()).collect();
    assert!(!inputs.is_empty());
    inputs
}

#[test]
fn models_are_refused_or_answer() {
    for bytes in corpus("model_file") {
        model_file::model_file(&bytes);
    }
}

#[test]
fn constraints_are_refused_in_one_line_or_read() {
    for bytes in corpus("constraint_file") {
        constraint_file::constraint_file(&String::from_utf8(bytes).unwrap());
    }
}
