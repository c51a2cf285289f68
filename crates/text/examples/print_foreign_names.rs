//! Prints names that came with a recording: for a terminal, and as words of a command to copy.

#![allow(clippy::print_stdout, reason = "a program")]

use std::path::Path;

use text::{is_hidden, plain, quoted};

fn main() {
    // The second would clear the screen, the third would turn the direction of writing.
    for name in ["q̇₁ (rad/s)", "\u{1b}[2Jforce", "left\u{202e}thgir"] {
        let note = if name.contains(is_hidden) { "  <- has hidden characters" } else { "" };
        println!("channel  {}{note}", plain(name));
    }
    // The second would delete files, the third would be taken for an option.
    for file in ["reach.csv", "a; rm -rf b.csv", "-o.csv", "two\nlines.csv"] {
        println!("command  policy-align check {}", quoted(Path::new(file)));
    }
}
