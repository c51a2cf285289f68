//! Makes text of unknown origin safe to print: names of channels, units and files come from recordings, which may
//! be untrusted.
//!
//! - [`plain`]: for a terminal, a drawing or a comment.
//! - [`quoted`]: a path in a suggested command.
//! - [`three_lines`]: an error.
//!
//! ```
//! use std::path::Path;
//!
//! assert_eq!(text::plain("\u{1b}[2Jx"), "\\u{1b}[2Jx");
//! assert_eq!(text::quoted(Path::new("a;b.csv")), "'a;b.csv'");
//! ```

mod plain;
mod quoted;
mod three_lines;

pub use plain::{is_hidden, plain};
pub use quoted::quoted;
pub use three_lines::three_lines;

/// Compiles the program in the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
