//! Prints names from a recording: for a terminal, and as words of a command to be copied.

#![allow(clippy::print_stdout, reason = "a program")]

use std::path::Path;

use text::{is_hidden, plain, quoted};

fn main() {
    // The second name would clear the screen, the third would reverse the writing direction.
    for name in ["q̇₁ (rad/s)", "\u{1b}[2Jforce", "left\u{202e}thgir"] {
        let note = if name.contains(is_hidden) { "  <- has hidden characters" } else { "" };
        println!("channel  {}{note}", plain(name));
    }
    // The second name would delete files, the third would be read as an option.
    for file in ["reach.csv", "a; rm -rf b.csv", "-o.csv", "two\nlines.csv"] {
        println!("command  policy-align check {}", quoted(Path::new(file)));
    }
}
