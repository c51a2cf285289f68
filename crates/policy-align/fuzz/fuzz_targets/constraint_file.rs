#![no_main]

#[path = "../fuzzed/constraint_file.rs"]
mod constraint_file;

libfuzzer_sys::fuzz_target!(|text: &str| constraint_file::constraint_file(text));
