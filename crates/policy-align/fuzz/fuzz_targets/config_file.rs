#![no_main]
#![allow(dead_code, reason = "these are parts of the program")]

#[path = "../../src/cli"]
mod cli {
    pub(crate) mod failure;
    pub(crate) mod options;
    pub(crate) mod session;
}
#[path = "../fuzzed/config_file.rs"]
mod config_file;

libfuzzer_sys::fuzz_target!(|text: &str| config_file::config_file(text));
